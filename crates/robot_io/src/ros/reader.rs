//! Frames of a recording, whatever its container.

use std::io::BufRead;

use super::bag_file::BagFile;
use super::collector::Collector;
use super::container::{Container, ContainerError};
use super::mcap_file::McapFile;
use crate::log::{BrokenRecord, LogError, LogFrame, LogNotes, LogOptions, LogReader, Place};

/// Reads a recording, message by message.
pub struct RosReader<'a> {
    container: Box<dyn Container + 'a>,
    name: String,
    collector: Collector,
    notes: LogNotes,
    frames: usize,
    is_done: bool,
}

impl<'a> RosReader<'a> {
    /// A reader of an MCAP file; `name` is what errors call it.
    #[must_use]
    pub fn mcap(source: impl BufRead + 'a, name: &str, options: &LogOptions) -> Self {
        Self::new(Box::new(McapFile::new(source)), name, options)
    }

    /// A reader of a bag of ROS 1; `name` is what errors call it.
    #[must_use]
    pub fn bag(source: impl BufRead + 'a, name: &str, options: &LogOptions) -> Self {
        Self::new(Box::new(BagFile::new(source)), name, options)
    }

    fn new(container: Box<dyn Container + 'a>, name: &str, options: &LogOptions) -> Self {
        Self {
            container,
            name: name.to_owned(),
            collector: Collector::new(options),
            notes: LogNotes::default(),
            frames: 0,
            is_done: false,
        }
    }

    /// Takes what ends the recording early: an error where there was no scan, else a note.
    fn end_early(&mut self, error: ContainerError) -> Result<(), LogError> {
        let name = self.name.clone();
        let offset = self.container.offset();
        let place = Place::Byte(offset);
        match error {
            ContainerError::Io(source) => {
                return Err(LogError::Io {
                    name,
                    place,
                    source,
                });
            }
            ContainerError::CutOff(problem) => {
                self.notes.half_written = Some(BrokenRecord { place, problem });
            }
            ContainerError::Broken(problem) => {
                self.notes.leave_out(place, problem);
                let rest = "the rest of the file was not read".to_owned();
                self.notes.ended_early = Some(rest);
            }
        }
        Ok(())
    }

    fn nothing_found(&self) -> LogError {
        let broken = self.notes.first_broken.as_ref();
        let broken = broken.or(self.notes.half_written.as_ref());
        LogError::NoScans {
            name: self.name.clone(),
            detail: match broken {
                Some(broken) => format!("{}: {}", broken.place, broken.problem),
                None => {
                    let instead = self.container.instead();
                    instead.unwrap_or_else(|| self.collector.without_scans())
                }
            },
        }
    }
}

impl LogReader for RosReader<'_> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        loop {
            if let Some(frame) = self.collector.pop() {
                self.frames += 1;
                if self.frames == 1 {
                    if let Some((option, wanted)) = self.collector.missing() {
                        return Err(LogError::Missing {
                            name: self.name.clone(),
                            option: option.name(),
                            wanted,
                            advice: self.collector.instead_of(option),
                        });
                    }
                    self.collector.tell(&mut self.notes);
                }
                return Ok(Some(frame));
            }
            if self.is_done {
                self.collector.tell(&mut self.notes);
                return if self.frames == 0 {
                    Err(self.nothing_found())
                } else {
                    Ok(None)
                };
            }
            match self.container.next_message() {
                Ok(Some(message)) => {
                    if let Err(problem) = self.collector.take(&message) {
                        let place = Place::Byte(self.container.offset());
                        self.notes.leave_out(place, problem);
                    }
                }
                Ok(None) => {
                    self.is_done = true;
                    self.collector.finish();
                }
                Err(error) => {
                    self.is_done = true;
                    self.collector.finish();
                    self.end_early(error)?;
                }
            }
            self.notes.bytes = self.container.offset();
        }
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}
