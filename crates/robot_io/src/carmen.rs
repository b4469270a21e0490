//! CARMEN logs: one message on each line, its kind first.
//!
//! | line | what it says |
//! |---|---|
//! | `FLASER n r… laser_pose odom_pose ipc_time host logger_time` | ranges from −90° on, counter-clockwise |
//! | `ROBOTLASER1 type start fov step max … n r… m e… laser_pose robot_pose tv rv … ipc_time host logger_time` | ranges with their geometry |
//! | `RAWLASER1 type start fov step max … n r… m e… ipc_time host logger_time` | the same without poses |
//! | `ODOM x y θ tv rv acceleration ipc_time host logger_time` | the wheels' pose |
//! | `PARAM name value …` | mounting, longest range and field of view of the front laser |
//!
//! The first kind of scan that comes with odometry is the one that is read; others are counted. A
//! raw scan waits for the ODOM line after it and takes the pose in between.
//!
//! Source: Roy, Montemerlo, Thrun, "Perspectives on standardization in mobile robot programming: the
//! Carnegie Mellon navigation (CARMEN) toolkit", 2003, and the header that its logger writes.

mod fields;
mod raw_scans;
mod sensor;
mod write;

use std::io::BufRead;

pub use write::write_carmen;

use crate::lines::{LineEnd, next_line, printable};
use crate::log::{BrokenRecord, LogError, LogFrame, LogNotes, LogReader, Place};
use fields::{Fields, laser_message, odometry_message};
use raw_scans::RawScans;
use sensor::FrontLaser;

/// So many lines without one known word are no CARMEN log.
const FOREIGN_AFTER_LINES: usize = 200;

/// Which message the scans come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    Flaser,
    RobotLaser,
    RawLaser,
}

/// Reads a CARMEN log, line by line.
#[derive(Debug)]
pub struct CarmenReader<R> {
    source: R,
    name: String,
    line: Vec<u8>,
    notes: LogNotes,
    front: FrontLaser,
    chosen: Option<Source>,
    raw: RawScans,
    frames: usize,
    known_lines: usize,
    is_done: bool,
}

impl<R: BufRead> CarmenReader<R> {
    /// A reader at the log's start; `name` is what errors call it.
    #[must_use]
    pub fn new(source: R, name: &str) -> Self {
        Self {
            source,
            name: name.to_owned(),
            line: Vec::new(),
            notes: LogNotes::default(),
            front: FrontLaser::default(),
            chosen: None,
            raw: RawScans::default(),
            frames: 0,
            known_lines: 0,
            is_done: false,
        }
    }

    /// Takes one line; answers with its frame where it completes one.
    fn take_line(&mut self) -> Result<Option<LogFrame>, String> {
        let text = std::str::from_utf8(&self.line)
            .map_err(|_| "the line has to be text, and holds other bytes".to_owned())?;
        let text = text.trim_start_matches('\u{feff}').trim();
        if text.is_empty() || text.starts_with('#') {
            return Ok(None);
        }
        let mut fields = Fields::of(text);
        let kind = fields.word();
        let count = |notes: &mut LogNotes| {
            *notes.records.entry(printable(kind)).or_default() += 1;
        };
        match kind {
            "FLASER" => {
                let frame = self.front.frame(&mut fields, self.frames)?;
                count(&mut self.notes);
                self.known_lines += 1;
                Ok(self.choose(Source::Flaser).then_some(frame))
            }
            "ROBOTLASER1" => {
                let frame = laser_message(&mut fields, true, self.frames)?;
                count(&mut self.notes);
                self.known_lines += 1;
                Ok(self.choose(Source::RobotLaser).then_some(frame))
            }
            "RAWLASER1" => {
                let frame = laser_message(&mut fields, false, self.frames)?;
                count(&mut self.notes);
                self.known_lines += 1;
                // A log often has the same scan as ROBOTLASER1 right after it.
                if matches!(self.chosen, None | Some(Source::RawLaser)) {
                    self.raw.push(frame);
                }
                Ok(None)
            }
            "ODOM" => {
                let (stamp_s, pose) = odometry_message(&mut fields)?;
                count(&mut self.notes);
                self.known_lines += 1;
                self.raw.take_odometry(stamp_s, pose);
                Ok(None)
            }
            "PARAM" => {
                self.known_lines += 1;
                count(&mut self.notes);
                self.front.take_parameter(&mut fields);
                Ok(None)
            }
            _ => {
                // Other messages of a robot: words in capitals.
                let is_message = kind
                    .bytes()
                    .all(|b| b.is_ascii_uppercase() || b.is_ascii_digit() || b == b'_');
                if !is_message || kind.parse::<f64>().is_ok() {
                    return Err(format!(
                        "a line has to start with the name of a message, such as FLASER, and starts with ‘{}’",
                        printable(kind)
                    ));
                }
                // A log of garbage has no end of names: memory is bounded.
                if self.notes.records.len() < 100 {
                    count(&mut self.notes);
                }
                Ok(None)
            }
        }
    }

    /// Whether scans of this kind are the ones that are read.
    fn choose(&mut self, kind: Source) -> bool {
        if self.chosen.is_none() {
            self.chosen = Some(kind);
            self.raw.forget();
        }
        self.chosen == Some(kind)
    }

    fn raw_frame(&mut self) -> Option<LogFrame> {
        let frame = self.raw.pop(self.is_done)?;
        self.choose(Source::RawLaser).then_some(frame)
    }

    fn nothing_found(&self) -> LogError {
        let name = self.name.clone();
        if self.notes.bytes == 0 {
            return LogError::Empty { name };
        }
        if self.known_lines == 0 {
            return LogError::Foreign {
                name,
                found: "no CARMEN log",
                advice: "give one with lines that start with FLASER, ROBOTLASER1 or RAWLASER1",
            };
        }
        let detail = match (&self.notes.first_broken, &self.notes.half_written) {
            (Some(broken), _) | (None, Some(broken)) => {
                format!("{}: {}", broken.place, broken.problem)
            }
            (None, None) => {
                "no line starts with FLASER, ROBOTLASER1 or RAWLASER1; record the laser as well"
                    .to_owned()
            }
        };
        LogError::NoScans { name, detail }
    }
}

impl<R: BufRead> LogReader for CarmenReader<R> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        loop {
            if let Some(frame) = self.raw_frame() {
                self.frames += 1;
                return Ok(Some(frame));
            }
            if self.is_done {
                return Ok(None);
            }
            let read =
                next_line(&mut self.source, &mut self.line).map_err(|source| LogError::Io {
                    name: self.name.clone(),
                    place: Place::Line(self.notes.lines + 1),
                    source,
                })?;
            let Some((end, bytes)) = read else {
                self.is_done = true;
                if self.frames == 0 && self.raw.is_empty() {
                    return Err(self.nothing_found());
                }
                continue;
            };
            self.notes.lines += 1;
            self.notes.bytes += bytes;
            let taken = if end == LineEnd::TooLong {
                Err("a line has to be shorter than 4 MB".to_owned())
            } else {
                self.take_line()
            };
            match taken {
                Ok(Some(frame)) => {
                    self.frames += 1;
                    return Ok(Some(frame));
                }
                Ok(None) => {}
                Err(problem) if end == LineEnd::CutOff => {
                    self.notes.half_written = Some(BrokenRecord {
                        place: Place::Line(self.notes.lines),
                        problem,
                    });
                }
                Err(problem) => {
                    let place = Place::Line(self.notes.lines);
                    self.notes.leave_out(place, problem);
                }
            }
            if self.known_lines == 0 && self.notes.lines >= FOREIGN_AFTER_LINES {
                return Err(self.nothing_found());
            }
        }
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

#[cfg(test)]
mod tests;
