//! What every log yields, whatever its format.

pub use ch16_slam2d::pipeline::LogFrame;
use std::collections::BTreeMap;
use std::fmt;
use std::io;

use thiserror::Error;

use crate::laser_mount::LaserMount;
use crate::remark::Remark;

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePosition {
    /// Number of the line, counted from 1.
    Line(usize),
    /// Bytes before it, or before the end of the record that it is in.
    Byte(u64),
}

impl fmt::Display for FilePosition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// Which of several topics and frames of a recording are meant; none: found by type.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LogOptions {
    /// The topic that scans come from; else the first one with scans.
    pub scan_topic: Option<String>,
    /// The topic that the wheels' poses come from, or /tf; else the first one of nav_msgs/Odometry,
    /// and /tf where there is none.
    pub odometry_topic: Option<String>,
    /// The frame that /tf gives the wheels' poses in; else one whose name holds ‘odom’.
    pub odometry_frame: Option<String>,
    /// The frame of the robot's body; else the one that the odometry moves.
    pub body_frame: Option<String>,
    /// Where the laser sits, in place of what the recording says.
    pub laser: Option<LaserMount>,
    /// Where the laser sits if neither an option nor the recording says: as in the session that it goes on with.
    pub laser_before: Option<LaserMount>,
    /// Heights (m) that points of a 3-D sensor have to lie between, on the body; else only clouds of one ring are read.
    pub heights_m: Option<(f64, f64)>,
}

/// One of [`LogOptions`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogOption {
    /// [`LogOptions::scan_topic`].
    ScanTopic,
    /// [`LogOptions::odometry_topic`].
    OdometryTopic,
    /// [`LogOptions::odometry_frame`].
    OdometryFrame,
    /// [`LogOptions::body_frame`].
    BodyFrame,
}

impl LogOption {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::ScanTopic,
        Self::OdometryTopic,
        Self::OdometryFrame,
        Self::BodyFrame,
    ];

    /// Its name on the command line, without the dashes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ScanTopic => "scan-topic",
            Self::OdometryTopic => "odom-topic",
            Self::OdometryFrame => "odom-frame",
            Self::BodyFrame => "body-frame",
        }
    }
}

impl LogOptions {
    /// The same options with one of them chosen.
    #[must_use]
    pub fn with(mut self, option: LogOption, value: &str) -> Self {
        let slot = match option {
            LogOption::ScanTopic => &mut self.scan_topic,
            LogOption::OdometryTopic => &mut self.odometry_topic,
            LogOption::OdometryFrame => &mut self.odometry_frame,
            LogOption::BodyFrame => &mut self.body_frame,
        };
        *slot = Some(value.to_owned());
        self
    }
}

/// What a recording offers for one of its options.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogOffer {
    /// The option.
    pub option: LogOption,
    /// What is taken; none where nothing is.
    pub taken: Option<String>,
    /// What may be taken, in the order of the alphabet.
    pub names: Vec<String>,
}

/// A line or record that could not be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrokenRecord {
    /// Where it is.
    pub place: FilePosition,
    /// What was expected, and what stands there.
    pub problem: String,
}

/// What a reader has met so far, besides frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LogNotes {
    /// How many records of each kind were read.
    pub records: BTreeMap<String, usize>,
    /// Lines or records that were left out because they could not be read.
    pub broken: usize,
    /// The first of them.
    pub first_broken: Option<BrokenRecord>,
    /// The last line or record, where it was cut off in the middle.
    pub half_written: Option<BrokenRecord>,
    /// Lines read.
    pub lines: usize,
    /// Bytes read.
    pub bytes: u64,
    /// What was chosen and found: topics, frames, where the laser sits.
    pub about: Vec<String>,
    /// What options could choose; nothing in a log of lines.
    pub offers: Vec<LogOffer>,
    /// Where the laser sits, where the recording or an option says it.
    pub laser: Option<LaserMount>,
    /// What was missing and how it was made up for.
    pub warnings: Vec<Remark>,
    /// Why what follows in the file was not read.
    pub ended_early: Option<String>,
}

impl LogNotes {
    /// What the owner of the log should know, a sentence each.
    #[must_use]
    pub fn sentences(&self, name: &str) -> Vec<String> {
        let mut said = Vec::new();
        if let Some(first) = &self.first_broken {
            let thing = match first.place {
                FilePosition::Line(_) => "line",
                FilePosition::Byte(_) => "record",
            };
            let count = match self.broken {
                1 => format!("one {thing} was left out"),
                many => format!("{many} {thing}s were left out"),
            };
            let rest = self.ended_early.as_ref();
            let rest = rest.map_or(String::new(), |rest| format!("; {rest}"));
            let at = if first.place == FilePosition::Byte(0) || thing == "line" {
                "is"
            } else {
                "ends at"
            };
            said.push(format!(
                "{name}: {count}; the first {at} {}: {}{rest}",
                first.place, first.problem
            ));
        }
        if let Some(last) = &self.half_written {
            said.push(match last.place {
                FilePosition::Line(line) => format!(
                    "{name}: the last line, {line}, is half written and was left out: {}",
                    last.problem
                ),
                FilePosition::Byte(byte) => format!(
                    "{name}: the file is cut off at byte {byte}, and what stood there was left out: {}",
                    last.problem
                ),
            });
        }
        let warnings = self.warnings.iter();
        said.extend(warnings.map(|warning| format!("{name}: {}", warning.text)));
        said
    }

    pub(crate) fn leave_out(&mut self, place: FilePosition, problem: String) {
        self.broken += 1;
        if self.first_broken.is_none() {
            self.first_broken = Some(BrokenRecord { place, problem });
        }
    }
}

/// Why a log cannot be read.
#[derive(Debug, Error)]
pub enum LogError {
    /// The system could not give its bytes.
    #[error("{name}: {place}: {source}")]
    Io {
        /// The log's name.
        name: String,
        /// Where it happened.
        place: FilePosition,
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
    /// A topic or frame that was asked for and is not there.
    #[error("{name} has no {option} {wanted}; {advice}")]
    Missing {
        /// The log's name.
        name: String,
        /// Name of the option: `odom-topic`.
        option: &'static str,
        /// What was asked for.
        wanted: String,
        /// What there is.
        advice: String,
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
