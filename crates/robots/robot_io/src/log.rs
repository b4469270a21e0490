//! Output of every log reader: frames, notes and errors.

pub use ch16_slam2d::pipeline::LogFrame;
use std::collections::BTreeMap;
use std::fmt;
use std::io;

use thiserror::Error;

use crate::laser_mount::LaserMount;
pub use crate::log_options::{LogOption, LogOptions};
use crate::remark::Remark;

/// A position in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePosition {
    /// Number of the line, counted from 1.
    Line(usize),
    /// Byte offset, or the offset of the end of the record that contains it.
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

/// The choices that a recording offers for one option.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogOffer {
    /// The option.
    pub option: LogOption,
    /// The choice in use; `None` if there is none.
    pub taken: Option<String>,
    /// Possible choices, sorted.
    pub names: Vec<String>,
}

/// A line or record that could not be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrokenRecord {
    /// Position.
    pub position: FilePosition,
    /// What was expected and what was found.
    pub problem: String,
}

/// Counts, choices and problems of a reader so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LogNotes {
    /// Number of records of each kind.
    pub records: BTreeMap<String, usize>,
    /// Number of lines or records that were skipped as unreadable.
    pub broken: usize,
    /// The first of them.
    pub first_broken: Option<BrokenRecord>,
    /// The last line or record, if it is incomplete.
    pub truncated: Option<BrokenRecord>,
    /// Lines read.
    pub lines: usize,
    /// Bytes read.
    pub bytes: u64,
    /// Choices made and what was found: topics, frames, mounting.
    pub about: Vec<String>,
    /// Choices for options; empty in a log of lines.
    pub offers: Vec<LogOffer>,
    /// Topics of the scans of each further robot, separated by commas.
    pub robots: Vec<String>,
    /// Mounting of the laser, if the recording or an option states it.
    pub laser: Option<LaserMount>,
    /// What was missing and how it was repaired.
    pub warnings: Vec<Remark>,
    /// Why the rest of the file was not read.
    pub ended_early: Option<String>,
}

impl LogNotes {
    /// Sentences for the user, without those about the choices.
    #[must_use]
    pub fn sentences(&self, name: &str) -> Vec<String> {
        let mut sentences = Vec::new();
        if let Some(first) = &self.first_broken {
            let thing = match first.position {
                FilePosition::Line(_) => "line",
                FilePosition::Byte(_) => "record",
            };
            let count = match self.broken {
                1 => format!("one {thing} was skipped"),
                many => format!("{many} {thing}s were skipped"),
            };
            let rest = self.ended_early.as_ref();
            let rest = rest.map_or(String::new(), |rest| format!("; {rest}"));
            let at = if first.position == FilePosition::Byte(0) || thing == "line" {
                "is"
            } else {
                "ends at"
            };
            sentences.push(format!(
                "{name}: {count}; the first {at} {}: {}{rest}",
                first.position, first.problem
            ));
        }
        if self.first_broken.is_none()
            && let Some(rest) = &self.ended_early
        {
            sentences.push(format!("{name}: {rest}"));
        }
        if let Some(last) = &self.truncated {
            sentences.push(match last.position {
                FilePosition::Line(line) => format!(
                    "{name}: the last line, {line}, is incomplete and was skipped: {}",
                    last.problem
                ),
                FilePosition::Byte(byte) => format!(
                    "{name}: the file is cut off at byte {byte}, and the incomplete record was skipped: {}",
                    last.problem
                ),
            });
        }
        let warnings = self.warnings.iter();
        sentences.extend(warnings.map(|warning| format!("{name}: {}", warning.text)));
        sentences
    }

    pub(crate) fn skip(&mut self, position: FilePosition, problem: String) {
        self.broken += 1;
        if self.first_broken.is_none() {
            self.first_broken = Some(BrokenRecord { position, problem });
        }
    }
}

/// Why a log cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LogError {
    /// The bytes could not be read.
    #[error("{name}: {position}: {source}")]
    Io {
        /// The log's name.
        name: String,
        /// Position.
        position: FilePosition,
        /// The system's error.
        source: io::Error,
    },
    /// The file is empty.
    #[error("{name} is empty; use a recorded log")]
    Empty {
        /// The log's name.
        name: String,
    },
    /// The file is not a log.
    #[error("{name} is {found}; {advice}")]
    Foreign {
        /// The log's name.
        name: String,
        /// What it is.
        found: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// The file is text of no known form.
    #[error(
        "{name} is not a CARMEN log; use one with lines that start with FLASER, ROBOTLASER1 or RAWLASER1. Its first line is {line}; {advice}"
    )]
    UnknownText {
        /// The log's name.
        name: String,
        /// The start of its first line, quoted.
        line: String,
        /// How its columns may be read.
        advice: String,
    },
    /// The file of odometry beside the log cannot be used.
    #[error("{name}: {problem}")]
    Odometry {
        /// The file's name.
        name: String,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// A requested topic or frame does not exist.
    #[error("{name} has no {option} {wanted}; {advice}")]
    Missing {
        /// The log's name.
        name: String,
        /// Option, for example `odom-topic`.
        option: &'static str,
        /// The requested name.
        wanted: String,
        /// The names that exist.
        advice: String,
    },
    /// More of a recording that is being made has to come first; then the next call goes on.
    #[error("nothing more has come yet")]
    Waiting,
    /// The file has records but no usable scan.
    #[error("{name} has no usable scan: {detail}")]
    NoScans {
        /// The log's name.
        name: String,
        /// What it contains instead.
        detail: String,
    },
}

impl LogError {
    /// An error of the system before the first record.
    pub(crate) fn at_start(name: &str, source: io::Error) -> Self {
        Self::Io {
            name: name.to_owned(),
            position: FilePosition::Byte(0),
            source,
        }
    }
}

/// Reads the scans of a log in order.
///
/// Skips an unreadable record and counts it in [`notes`](Self::notes).
pub trait LogReader {
    /// Returns the next scan with its odometry; `None` at the end.
    ///
    /// # Errors
    /// If the log as a whole is unusable.
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError>;

    /// Counts, choices and problems so far.
    fn notes(&self) -> &LogNotes;

    /// The robot of the last frame, once, if that is the first one of a robot after the first.
    fn next_robot(&mut self) -> Option<String> {
        None
    }
}

/// A reader whose notes begin with remarks on its files.
struct RemarkedReader<'a> {
    inner: Box<dyn LogReader + 'a>,
    remarks: Vec<Remark>,
    notes: LogNotes,
}

/// A reader with remarks on its files.
#[must_use]
pub fn with_remarks<'a>(
    inner: Box<dyn LogReader + 'a>,
    remarks: Vec<Remark>,
) -> Box<dyn LogReader + 'a> {
    if remarks.is_empty() {
        return inner;
    }
    Box::new(RemarkedReader {
        inner,
        remarks,
        notes: LogNotes::default(),
    })
}

impl LogReader for RemarkedReader<'_> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        let frame = self.inner.next_frame();
        self.notes.clone_from(self.inner.notes());
        self.notes
            .warnings
            .splice(0..0, self.remarks.iter().cloned());
        frame
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}
