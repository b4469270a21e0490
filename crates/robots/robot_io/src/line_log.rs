//! Reader of text logs, shared by all line formats.
//!
//! A format parses one line. The reader iterates over the file in bounded memory, skips unreadable lines, and reports
//! where they were.

use std::io::{self, BufRead};

use ch16_slam2d::scan::LaserScan;

use crate::foreign::Foreign;
use crate::lines::{LineEnd, excerpt, next_line};
use crate::log::{BrokenRecord, FilePosition, LogError, LogFrame, LogNotes, LogReader};
use crate::range_unit::{centimetres, in_metres};
use crate::remark::{Part, Remark};
use crate::table_layout::guess;

/// Parser of a format's lines, in order.
pub trait LineFormat: Default {
    /// What is missing in a log without scans.
    const NO_SCANS: &'static str;

    /// Takes one line without its newline; returns a frame if the line completes one. `frames` is the number of frames
    /// before it, and `notes` counts the records.
    ///
    /// # Errors
    /// If the line is malformed: what was expected and what was found.
    fn read_line(
        &mut self,
        line: &[u8],
        frames: usize,
        notes: &mut LogNotes,
    ) -> Result<Option<LogFrame>, String>;

    /// A frame that waited for a later line or for the end.
    fn waiting(&mut self, _is_done: bool) -> Option<LogFrame> {
        None
    }

    /// Takes the end of the file.
    fn at_end(&mut self, _notes: &mut LogNotes) {}

    /// Whether this many lines are enough to conclude that the file has another format.
    fn is_foreign(&self, _lines: usize) -> bool {
        false
    }

    /// What a file without scans is, and what to do; `None` if it is a log of this format.
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
    /// The first lines of a file that may be of no known form.
    start: Vec<String>,
}

impl<R: BufRead, F: LineFormat> LineReader<R, F> {
    /// Creates a reader at the log's start; errors contain `name`.
    #[must_use]
    pub fn new(source: R, name: &str) -> Self {
        Self::with_format(source, name, F::default())
    }

    /// Creates a reader with the state of a format before the first line.
    #[must_use]
    pub fn with_format(source: R, name: &str, format: F) -> Self {
        Self {
            source,
            name: name.to_owned(),
            line: Vec::new(),
            notes: LogNotes::default(),
            format,
            frames: 0,
            is_done: false,
            start: Vec::new(),
        }
    }

    /// Keeps the first lines with text, until there is a frame.
    fn keep_start(&mut self) {
        let is_kept = self.frames == 0 && self.start.len() < guess::LINES;
        let text = std::str::from_utf8(&self.line).ok().filter(|_| is_kept);
        let text = text.map(str::trim).filter(|text| !text.is_empty());
        self.start.extend(text.map(str::to_owned));
    }

    /// Converts ranges that can only be in millimetres.
    fn convert(&mut self, scan: &mut LaserScan) {
        let mended = in_metres(scan).map(|text| Remark::mended(Part::Sensor, text));
        let named = || centimetres(&scan.ranges_m).map(|text| Remark::wrong(Part::Sensor, text));
        let Some(remark) = mended.or_else(named) else {
            return;
        };
        let is_said = |said: &Remark| said.part == Part::Sensor && said.verdict == remark.verdict;
        if !self.notes.warnings.iter().any(is_said) {
            self.notes.warnings.push(remark);
        }
    }

    fn no_scans_error(&self) -> LogError {
        let name = self.name.clone();
        if self.notes.bytes == 0 {
            return LogError::Empty { name };
        }
        if let Some(by_content) = self.format.foreign() {
            let by_name = Foreign::named(&name).map(|kind| (kind.found, kind.advice));
            let is_text = |line: &&String| !line.chars().any(|c| c.is_control() && c != '\t');
            if by_name.is_none()
                && let Some(line) = self.start.first().filter(is_text)
            {
                return LogError::UnknownText {
                    line: format!("‘{}’", excerpt(line)),
                    advice: guess::advice(&self.start),
                    name,
                };
            }
            let (found, advice) = by_name.unwrap_or(by_content);
            return LogError::Foreign {
                name,
                found,
                advice,
            };
        }
        let broken = self.notes.first_broken.as_ref();
        let detail = match broken.or(self.notes.truncated.as_ref()) {
            Some(broken) => format!("{}: {}", broken.position, broken.problem),
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
                    Err(self.no_scans_error())
                } else {
                    Ok(None)
                };
            }
            let read = match next_line(&mut self.source, &mut self.line) {
                Ok(read) => read,
                Err(source) => {
                    let advice = format!(
                        "{source}; the rest of the file was not read. Copy it again from its source"
                    );
                    return Err(LogError::Io {
                        name: self.name.clone(),
                        position: FilePosition::Line(self.notes.lines + 1),
                        source: io::Error::new(source.kind(), advice),
                    });
                }
            };
            let Some((end, bytes)) = read else {
                self.is_done = true;
                self.format.at_end(&mut self.notes);
                continue;
            };
            self.notes.lines += 1;
            self.notes.bytes += bytes;
            self.keep_start();
            let position = FilePosition::Line(self.notes.lines);
            let taken = if end == LineEnd::TooLong {
                Err("a line must be shorter than 4 MB".to_owned())
            } else {
                self.format
                    .read_line(&self.line, self.frames, &mut self.notes)
            };
            match taken {
                Ok(Some(mut frame)) => {
                    self.frames += 1;
                    self.convert(&mut frame.scan);
                    return Ok(Some(frame));
                }
                Ok(None) => {}
                Err(problem) if end == LineEnd::CutOff => {
                    self.notes.truncated = Some(BrokenRecord { position, problem });
                }
                Err(problem) => self.notes.skip(position, problem),
            }
            if self.format.is_foreign(self.notes.lines) {
                return Err(self.no_scans_error());
            }
        }
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}
