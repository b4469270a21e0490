//! What every log yields, whatever its format.

use std::collections::BTreeMap;
use std::io::{self, BufRead};

use ch16_slam2d::scan::LaserScan;
use pr_geom::SE2;
use thiserror::Error;

use crate::carmen::CarmenReader;

/// A scan of a log, with the odometry at its time.
#[derive(Clone, Debug, PartialEq)]
pub struct LogFrame {
    /// Time of the scan, s; the number of the frame where the log has no times.
    pub stamp_s: f64,
    /// Pose of the body in the odometry's frame, where the log has one.
    pub odometry: Option<SE2>,
    /// The scan with its geometry.
    pub scan: LaserScan,
}

/// A line or record that could not be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrokenLine {
    /// Number of the line, counted from 1.
    pub line: usize,
    /// What was expected, and what stands there.
    pub problem: String,
}

/// What a reader has met so far, besides frames.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LogNotes {
    /// How many records of each kind were read.
    pub records: BTreeMap<String, usize>,
    /// Lines that were left out because they could not be read.
    pub broken: usize,
    /// The first of them.
    pub first_broken: Option<BrokenLine>,
    /// The last line, where it was cut off in the middle.
    pub half_written: Option<BrokenLine>,
    /// Lines read.
    pub lines: usize,
    /// Bytes read.
    pub bytes: u64,
}

impl LogNotes {
    /// What the owner of the log should know, a sentence each.
    #[must_use]
    pub fn sentences(&self, name: &str) -> Vec<String> {
        let mut said = Vec::new();
        if let Some(first) = &self.first_broken {
            let count = match self.broken {
                1 => "one line was left out".to_owned(),
                many => format!("{many} lines were left out"),
            };
            said.push(format!(
                "{name}: {count}; the first is line {}: {}",
                first.line, first.problem
            ));
        }
        if let Some(last) = &self.half_written {
            said.push(format!(
                "{name}: the last line, {}, is half written and was left out: {}",
                last.line, last.problem
            ));
        }
        said
    }

    pub(crate) fn leave_out(&mut self, problem: String) {
        self.broken += 1;
        if self.first_broken.is_none() {
            self.first_broken = Some(BrokenLine {
                line: self.lines,
                problem,
            });
        }
    }
}

/// Why a log cannot be read.
#[derive(Debug, Error)]
pub enum LogError {
    /// The system could not give its bytes.
    #[error("{name}: line {line}: {source}")]
    Io {
        /// The log's name.
        name: String,
        /// The line at which it happened.
        line: usize,
        /// What the system says.
        source: io::Error,
    },
    /// There is nothing in it.
    #[error("{name} is empty; give a recorded log")]
    Empty {
        /// The log's name.
        name: String,
    },
    /// It is something else than a log.
    #[error("{name} is {found}; {advice}")]
    Foreign {
        /// The log's name.
        name: String,
        /// What it looks like.
        found: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// It has records, but no scan that could be used.
    #[error("{name} holds no scan that can be used: {detail}")]
    NoScans {
        /// The log's name.
        name: String,
        /// What it holds instead.
        detail: String,
    },
}

/// Reads the scans of a log, one after the other.
///
/// A record in the middle that cannot be read is left out and counted in [`notes`](Self::notes).
pub trait LogReader {
    /// The next scan with its odometry; none at the end.
    ///
    /// # Errors
    /// Where the log as a whole cannot be used.
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError>;

    /// What was met so far.
    fn notes(&self) -> &LogNotes;
}

/// The formats that are told apart by their first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogFormat {
    /// Lines of text, one message each.
    Carmen,
    /// A container of ROS 2 messages.
    Mcap,
    /// A recording of ROS 1.
    RosBag,
    /// Compressed by gzip.
    Gzip,
    /// A pose graph of g2o or TORO.
    Graph,
}

impl LogFormat {
    /// The format that a file's first bytes belong to; CARMEN's is what is nothing else.
    #[must_use]
    pub fn detect(start: &[u8]) -> Self {
        let starts = |magic: &[u8]| start.starts_with(magic);
        if starts(b"\x89MCAP0\r\n") {
            Self::Mcap
        } else if starts(b"#ROSBAG") {
            Self::RosBag
        } else if starts(b"\x1f\x8b") {
            Self::Gzip
        } else if starts(b"VERTEX") || starts(b"EDGE") {
            Self::Graph
        } else {
            Self::Carmen
        }
    }

    /// Opens a log by its first bytes; `name` is what errors call it.
    ///
    /// # Errors
    /// Where the bytes cannot be had, there are none, or the format holds no log that is read here.
    pub fn open<'a>(
        mut bytes: impl BufRead + 'a,
        name: &str,
    ) -> Result<Box<dyn LogReader + 'a>, LogError> {
        let start = bytes.fill_buf().map_err(|source| LogError::Io {
            name: name.to_owned(),
            line: 1,
            source,
        })?;
        if start.is_empty() {
            return Err(LogError::Empty {
                name: name.to_owned(),
            });
        }
        let foreign = |found, advice| LogError::Foreign {
            name: name.to_owned(),
            found,
            advice,
        };
        match Self::detect(start) {
            Self::Carmen => Ok(Box::new(CarmenReader::new(bytes, name))),
            Self::Mcap => Err(foreign(
                "a recording of ROS 2 (MCAP)",
                "give a CARMEN log with FLASER, ROBOTLASER1 or RAWLASER1 lines",
            )),
            Self::RosBag => Err(foreign(
                "a recording of ROS 1 (bag)",
                "give a CARMEN log with FLASER, ROBOTLASER1 or RAWLASER1 lines",
            )),
            Self::Gzip => Err(foreign(
                "compressed by gzip",
                "unpack it with gunzip and give the result",
            )),
            Self::Graph => Err(foreign(
                "a pose graph, not a log of scans",
                "optimize it with slam2d optimize",
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_and_foreign_files_are_refused_in_one_sentence() {
        for (bytes, said) in [
            (&b""[..], "x.log is empty; give a recorded log"),
            (
                b"\x1f\x8b\x08",
                "x.log is compressed by gzip; unpack it with gunzip and give the result",
            ),
            (
                b"VERTEX_SE2 0 0 0 0\n",
                "x.log is a pose graph, not a log of scans; optimize it with slam2d optimize",
            ),
        ] {
            let error = LogFormat::open(bytes, "x.log").err().unwrap();
            assert_eq!(error.to_string(), said);
        }
        for bytes in [&b"\x89MCAP0\r\n"[..], b"#ROSBAG V2.0\n"] {
            let error = LogFormat::open(bytes, "x.log").err().unwrap();
            assert!(error.to_string().contains("a recording of ROS"));
        }
    }
}
