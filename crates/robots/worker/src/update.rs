//! Updates of the engine: reports for the widget, and what the page itself shows or keeps.

use log_messages::{MapperOrder, MapperReport};
use robot_io::doctor::Diagnosis;
use serde::Serialize;

/// One update.
#[derive(Clone, Debug)]
pub enum Update {
    /// For the widget.
    Report(MapperReport),
    /// For the page: the doctor's report.
    Diagnosis(Box<Diagnosis>),
    /// For the page: the loops in doubt.
    Evidence(Evidence),
    /// For the page: the robot that drives.
    Drive(DriveReport),
    /// For the page: the reader's changes so far, with which a new worker repeats them.
    Edits(Vec<MapperOrder>),
}

impl Update {
    /// The name of its kind: an update replaces an earlier one of the same kind.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Report(report) => report.kind(),
            Self::Diagnosis(_) => "diagnosis",
            Self::Evidence(_) => "evidence",
            Self::Drive(_) => "drive",
            Self::Edits(_) => "edits",
        }
    }

    /// What the page reads of it as JSON; empty for a report.
    #[must_use]
    pub fn json(&self) -> String {
        match self {
            Self::Report(_) => Ok(String::new()),
            Self::Diagnosis(diagnosis) => serde_json::to_string(diagnosis),
            Self::Evidence(evidence) => serde_json::to_string(evidence),
            Self::Drive(drive) => serde_json::to_string(drive),
            Self::Edits(edits) => serde_json::to_string(edits),
        }
        .expect("plain numbers, strings and lists")
    }
}

/// What came of a robot that drives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DriveReport {
    /// Topics that are read.
    pub reads: Vec<String>,
    /// Topics of laser scans that there are.
    pub lasers: Vec<String>,
    /// Number of scans that came, that were mapped, and that came too fast.
    pub scans: [usize; 3],
    /// What the network did last, in a sentence.
    pub said: String,
    /// Whether more may come.
    pub is_driving: bool,
}

/// The loops in the graph that the rest contradicts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Evidence {
    /// Their number.
    pub count: usize,
    /// The first few.
    pub loops: Vec<LoopEvidence>,
}

/// A loop in doubt.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoopEvidence {
    /// Its index in the list.
    pub index: usize,
    /// The newer and the older keyframe.
    pub ends: [usize; 2],
    /// χ² against the rest of the graph.
    pub chi2: f64,
    /// The gate.
    pub gate_chi2: f64,
    /// The points around the older and around the newer keyframe in the frame of the older, as the loop lays them on
    /// each other, m.
    pub scans: [Vec<[f64; 2]>; 2],
    /// The request that keeps it.
    pub accept: String,
    /// The request that removes it.
    pub reject: String,
}
