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
//! raw scan waits for the ODOM line after it and takes the pose in between. Where the laser sits is
//! what the two poses of a scan differ by, where they do so by the same all the while, or what PARAM
//! lines say.
//!
//! Source: Roy, Montemerlo, Thrun, "Perspectives on standardization in mobile robot programming: the
//! Carnegie Mellon navigation (CARMEN) toolkit", 2003, and the header that its logger writes.

mod fields;
mod raw_scans;
mod sensor;
mod write;

pub use write::write_carmen;

use crate::line_log::{LineFormat, LineReader};
use crate::lines::printable;
use crate::log::{LogFrame, LogNotes};
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
pub type CarmenReader<R> = LineReader<R, Carmen>;

/// What the lines of a CARMEN log said so far.
#[derive(Debug, Default)]
pub struct Carmen {
    front: FrontLaser,
    chosen: Option<Source>,
    raw: RawScans,
    known_lines: usize,
}

impl LineFormat for Carmen {
    const NO_SCANS: &'static str =
        "no line starts with FLASER, ROBOTLASER1 or RAWLASER1; record the laser as well";

    fn take_line(
        &mut self,
        line: &[u8],
        frames: usize,
        notes: &mut LogNotes,
    ) -> Result<Option<LogFrame>, String> {
        let text = std::str::from_utf8(line)
            .map_err(|_| "the line has to be text, and holds other bytes".to_owned())?;
        let text = text.trim_start_matches('\u{feff}').trim();
        if text.is_empty() || text.starts_with('#') {
            return Ok(None);
        }
        let mut fields = Fields::parse(text);
        let kind = fields.word();
        let records = notes.records.len();
        if ["FLASER", "ROBOTLASER1", "RAWLASER1", "ODOM", "PARAM"].contains(&kind) {
            self.known_lines += 1;
        }
        let mut count = || {
            *notes.records.entry(printable(kind)).or_default() += 1;
        };
        match kind {
            "FLASER" => {
                // What is not read waits for nothing.
                let mut other = FrontLaser::default();
                let is_read = matches!(self.chosen, None | Some(Source::Flaser));
                let front = if is_read { &mut self.front } else { &mut other };
                front.take(&mut fields, frames)?;
                count();
                self.choose(Source::Flaser);
                Ok(None)
            }
            "ROBOTLASER1" => {
                let frame = laser_message(&mut fields, true, frames)?;
                count();
                Ok(self.choose(Source::RobotLaser).then_some(frame))
            }
            "RAWLASER1" => {
                let mut frame = laser_message(&mut fields, false, frames + self.raw.waiting())?;
                count();
                frame.scan.body_from_sensor = self.front.told_mount().unwrap_or_default();
                // A log often has the same scan as ROBOTLASER1 right after it.
                if matches!(self.chosen, None | Some(Source::RawLaser)) {
                    self.raw.push(frame);
                }
                Ok(None)
            }
            "ODOM" => {
                let scans = frames + self.raw.waiting();
                let (stamp_s, pose) = odometry_message(&mut fields, scans)?;
                count();
                self.raw.take_odometry(stamp_s, pose);
                Ok(None)
            }
            "PARAM" => {
                count();
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
                if records < 100 {
                    count();
                }
                Ok(None)
            }
        }
    }

    fn waiting(&mut self, is_done: bool) -> Option<LogFrame> {
        if let Some(frame) = self.front.pop(is_done) {
            return Some(frame);
        }
        let frame = self.raw.pop(is_done)?;
        self.choose(Source::RawLaser).then_some(frame)
    }

    fn is_foreign(&self, lines: usize) -> bool {
        self.known_lines == 0 && lines >= FOREIGN_AFTER_LINES
    }

    fn foreign(&self) -> Option<(&'static str, &'static str)> {
        (self.known_lines == 0).then_some((
            "no CARMEN log",
            "give one with lines that start with FLASER, ROBOTLASER1 or RAWLASER1",
        ))
    }
}

impl Carmen {
    /// Whether scans of this kind are the ones that are read.
    fn choose(&mut self, kind: Source) -> bool {
        if self.chosen.is_none() {
            self.chosen = Some(kind);
            if kind != Source::RawLaser {
                self.raw.forget();
            }
        }
        self.chosen == Some(kind)
    }
}

#[cfg(test)]
mod tests;
