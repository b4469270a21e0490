//! CARMEN logs: one message on each line, its kind first.
//!
//! | line | content |
//! |---|---|
//! | `FLASER n r… laser_pose odom_pose ipc_time host logger_time` | ranges from −90° on, counter-clockwise |
//! | `ROBOTLASER1 type start fov step max … n r… m e… laser_pose robot_pose tv rv … ipc_time host logger_time` | ranges with their geometry |
//! | `RAWLASER1 type start fov step max … n r… m e… ipc_time host logger_time` | the same without poses |
//! | `ODOM x y θ tv rv acceleration ipc_time host logger_time` | pose by odometry |
//! | `VERTEX2 id x y θ`, `VERTEX_SE2 …` | in a graph with scans: the pose of the scan after it, as odometry |
//! | `PARAM name value …` | mounting, longest range and field of view of the front laser |
//!
//! Reads the first kind of scan that comes with odometry and counts the others. A raw scan waits for the next ODOM line
//! and takes the pose interpolated between the two around it. The mounting is the relative pose between the two poses
//! of a scan if it is constant, or what PARAM lines state.
//!
//! Source: Roy, Montemerlo, Thrun, "Perspectives on standardization in mobile robot programming: the
//! Carnegie Mellon navigation (CARMEN) toolkit", 2003, and the header that its logger writes.

mod fields;
mod raw_scans;
mod sensor;
mod write;

pub use write::write_carmen;

use pr_geom::SE2;

use crate::line_log::{LineFormat, LineReader};
use crate::lines::printable;
use crate::log::{LogFrame, LogNotes};
use fields::{Fields, laser_message, odometry_message};
use raw_scans::RawScans;
use sensor::FrontLaser;

/// A log with this many lines and no known message is not CARMEN.
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

/// State of a CARMEN log that is being read.
#[derive(Debug, Default)]
pub struct Carmen {
    front: FrontLaser,
    chosen: Option<Source>,
    raw: RawScans,
    /// The pose of the last vertex, in a graph that has scans.
    vertex: Option<SE2>,
    known_lines: usize,
}

impl LineFormat for Carmen {
    const NO_SCANS: &'static str =
        "no line starts with FLASER, ROBOTLASER1 or RAWLASER1; record the laser as well";

    fn read_line(
        &mut self,
        line: &[u8],
        frames: usize,
        notes: &mut LogNotes,
    ) -> Result<Option<LogFrame>, String> {
        let text = std::str::from_utf8(line)
            .map_err(|_| "the line must be UTF-8 text and contains other bytes".to_owned())?;
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
                // A kind that is not read must not keep frames.
                let mut other = FrontLaser::default();
                let is_read = matches!(self.chosen, None | Some(Source::Flaser));
                let front = if is_read { &mut self.front } else { &mut other };
                front.add_scan(&mut fields, frames)?;
                count();
                self.choose(Source::Flaser);
                Ok(None)
            }
            "ROBOTLASER1" => {
                let mut frame = laser_message(&mut fields, true, frames)?;
                if let Some(vertex) = self.vertex.take() {
                    frame.odometry = Some(vertex);
                }
                count();
                Ok(self.choose(Source::RobotLaser).then_some(frame))
            }
            "RAWLASER1" => {
                let mut frame = laser_message(&mut fields, false, frames + self.raw.waiting())?;
                count();
                frame.scan.body_from_sensor = self.front.stated_mount().unwrap_or_default();
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
                self.raw.add_odometry(stamp_s, pose);
                Ok(None)
            }
            "VERTEX2" | "VERTEX_SE2" => {
                fields.number("id")?;
                let vertex = fields.pose(["x", "y", "theta"])?;
                count();
                if notes.about.is_empty() {
                    notes.about.push(
                        "a graph with scans, whose vertices are taken as odometry".to_owned(),
                    );
                }
                self.vertex = Some(vertex);
                Ok(None)
            }
            "PARAM" => {
                count();
                self.front.read_parameter(&mut fields);
                Ok(None)
            }
            _ => {
                // Other messages of a robot: words in capitals.
                let is_message = kind
                    .bytes()
                    .all(|b| b.is_ascii_uppercase() || b.is_ascii_digit() || b == b'_');
                if !is_message || kind.parse::<f64>().is_ok() {
                    return Err(format!(
                        "a line must start with the name of a message, such as FLASER, but starts with ‘{}’",
                        printable(kind)
                    ));
                }
                // Garbage has an unbounded number of names: bound the memory.
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
            "not a CARMEN log",
            "use one with lines that start with FLASER, ROBOTLASER1 or RAWLASER1",
        ))
    }
}

impl Carmen {
    /// Returns whether frames of this kind are read; the first kind offered is chosen.
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
