//! Logs of lines: what every format of text shares.
//!
//! A format says what one line means. The reader goes through the file within a bound of memory, leaves
//! out what cannot be read, and says where that was.

use std::io::BufRead;

use crate::lines::{LineEnd, next_line};
use crate::log::{BrokenRecord, FilePosition, LogError, LogFrame, LogNotes, LogReader};

/// What the lines of a format mean, one after the other.
pub trait LineFormat: Default {
    /// What is missing in a log without any scan.
    const NO_SCANS: &'static str;

    /// Takes one line, without its newline; answers with its frame where it completes one. `frames` is
    /// how many came before, and `notes` counts the records.
    ///
    /// # Errors
    /// What was expected, and what stands there.
    fn take_line(
        &mut self,
        line: &[u8],
        frames: usize,
        notes: &mut LogNotes,
    ) -> Result<Option<LogFrame>, String>;

    /// A frame that waited for a later line, or for the end.
    fn waiting(&mut self, _is_done: bool) -> Option<LogFrame> {
        None
    }

    /// Whether so many lines are enough to tell that the file is something else.
    fn is_foreign(&self, _lines: usize) -> bool {
        false
    }

    /// What a file without scans is instead, and what to do; none where it is a log of this format.
    fn foreign(&self) -> Option<(&'static str, &'static str)> {
        None
    }
}

/// Reads a log line by line.
#[derive(Debug)]
pub struct LineReader<R, F> {
    source: R,
    name: String,
    line: Vec<u8>,
    notes: LogNotes,
    format: F,
    frames: usize,
    is_done: bool,
}

impl<R: BufRead, F: LineFormat> LineReader<R, F> {
    /// A reader at the log's start; `name` is what errors call it.
    #[must_use]
    pub fn new(source: R, name: &str) -> Self {
        Self {
            source,
            name: name.to_owned(),
            line: Vec::new(),
            notes: LogNotes::default(),
            format: F::default(),
            frames: 0,
            is_done: false,
        }
    }

    fn nothing_found(&self) -> LogError {
        let name = self.name.clone();
        if self.notes.bytes == 0 {
            return LogError::Empty { name };
        }
        if let Some((found, advice)) = self.format.foreign() {
            return LogError::Foreign {
                name,
                found,
                advice,
            };
        }
        let broken = self.notes.first_broken.as_ref();
        let detail = match broken.or(self.notes.half_written.as_ref()) {
            Some(broken) => format!("{}: {}", broken.place, broken.problem),
            None => F::NO_SCANS.to_owned(),
        };
        LogError::NoScans { name, detail }
    }
}

impl<R: BufRead, F: LineFormat> LogReader for LineReader<R, F> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        loop {
            if let Some(frame) = self.format.waiting(self.is_done) {
                self.frames += 1;
                return Ok(Some(frame));
            }
            if self.is_done {
                return if self.frames == 0 {
                    Err(self.nothing_found())
                } else {
                    Ok(None)
                };
            }
            let read =
                next_line(&mut self.source, &mut self.line).map_err(|source| LogError::Io {
                    name: self.name.clone(),
                    place: FilePosition::Line(self.notes.lines + 1),
                    source,
                })?;
            let Some((end, bytes)) = read else {
                self.is_done = true;
                continue;
            };
            self.notes.lines += 1;
            self.notes.bytes += bytes;
            let place = FilePosition::Line(self.notes.lines);
            let taken = if end == LineEnd::TooLong {
                Err("a line has to be shorter than 4 MB".to_owned())
            } else {
                self.format
                    .take_line(&self.line, self.frames, &mut self.notes)
            };
            match taken {
                Ok(Some(frame)) => {
                    self.frames += 1;
                    return Ok(Some(frame));
                }
                Ok(None) => {}
                Err(problem) if end == LineEnd::CutOff => {
                    self.notes.half_written = Some(BrokenRecord { place, problem });
                }
                Err(problem) => self.notes.leave_out(place, problem),
            }
            if self.format.is_foreign(self.notes.lines) {
                return Err(self.nothing_found());
            }
        }
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}
