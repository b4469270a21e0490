//! Messages between widget w16.10 and the worker that maps a reader's log: [`MapperReport`]s to the widget,
//! [`MapperOrder`]s to the worker.
//!
//! The page passes them on without reading them: a report as bytes of postcard beside its [kind](MapperReport::kind), of
//! which the page keeps the latest; an order as a line of JSON.

mod localization;
mod order;

use serde::{Deserialize, Serialize};

pub use localization::{LocalizationState, LocalizedScan, OtherLog};
pub use order::MapperOrder;

/// Stage of the worker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stage {
    /// No log is open.
    #[default]
    Empty,
    /// A log was opened, and the worker has not started yet.
    Opening,
    /// The file is read, scan by scan.
    Reading,
    /// No scan follows: the last loops are tested.
    Finishing,
    /// A graph file is optimized.
    Solving,
    /// The covariances are computed.
    Checking,
    /// The map is complete.
    Done,
    /// The file cannot be used.
    Failed,
}

impl Stage {
    /// Whether the worker can be paused.
    #[must_use]
    pub fn is_under_way(self) -> bool {
        matches!(
            self,
            Self::Opening | Self::Reading | Self::Finishing | Self::Solving
        )
    }
}

/// What the worker has done.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MapperProgress {
    /// Its stage.
    pub stage: Stage,
    /// Finished share of the work; NaN while a robot drives.
    pub share: f64,
    /// Number of processed scans.
    pub scans: usize,
    /// Number of loops that were closed while reading.
    pub closed: usize,
    /// Why the file cannot be used.
    pub problem: String,
}

/// A keyframe.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KeyframeReport {
    /// Time of its scan, s.
    pub stamp_s: f64,
    /// `[x, y, θ]`, m and rad.
    pub pose: [f64; 3],
    /// Where the odometry puts it, in the odometry's own frame; NaN where there is none.
    pub odometry: [f64; 3],
    /// Share of its scan that fits; NaN if it was not registered.
    pub fit: f64,
    /// Standard deviation of its position, m; NaN until it is known.
    pub sigma_m: f64,
}

/// The map as a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MapReport {
    /// Cells of a row.
    pub columns: usize,
    /// Corner with the least coordinates, m.
    pub min: [f64; 2],
    /// Size of a cell, m.
    pub cell_m: f64,
    /// Rows from the least y: 0 unknown, 1 free … 255 occupied.
    pub cells: Vec<u8>,
}

/// The decision on a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LoopDecision {
    /// Accepted by its tests, and in the graph.
    Closed,
    /// Rejected by its tests.
    Rejected,
    /// Removed by the reader.
    Removed,
    /// Added by the reader.
    Added,
    /// Kept by the reader although the rest of the graph contradicts it.
    Confirmed,
}

impl LoopDecision {
    /// Whether the graph contains the loop.
    #[must_use]
    pub fn is_in_graph(self) -> bool {
        matches!(self, Self::Closed | Self::Added | Self::Confirmed)
    }

    /// The opposite decision, by the reader.
    #[must_use]
    pub fn toggled(self) -> Self {
        if self.is_in_graph() {
            Self::Removed
        } else {
            Self::Added
        }
    }
}

/// A loop with its evidence; NaN for missing numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoopReport {
    /// The newer keyframe.
    pub new: usize,
    /// The older keyframe.
    pub old: usize,
    /// Share of the newer scan that fits.
    pub share: f64,
    /// Root mean square distance of the points that fit, m.
    pub rmse_m: f64,
    /// Points that fit.
    pub points: f64,
    /// Score margin to the best other pose.
    pub margin: f64,
    /// Squared innovation against the graph.
    pub chi2: f64,
    /// The gate's threshold.
    pub gate_chi2: f64,
    /// The decision.
    pub decision: LoopDecision,
    /// Why it failed the tests.
    pub reason: String,
}

impl LoopReport {
    /// Whether it is in the graph, and the rest of the graph contradicts it.
    #[must_use]
    pub fn is_contradicted(&self) -> bool {
        self.decision.is_in_graph() && self.chi2 > self.gate_chi2
    }
}

/// Points of a keyframe's scan in its own frame, m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScanReport {
    /// The keyframe.
    pub keyframe: usize,
    /// The points as they are registered.
    pub points: Vec<[f64; 2]>,
    /// The same as measured, with the motion during the sweep in it; empty if the scan counts as one instant.
    pub sweep: Vec<[f64; 2]>,
}

/// The errors against a reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GradeReport {
    /// In words.
    pub words: String,
    /// Mean error against relations, or RMSE against the truth, m.
    pub error_m: f64,
    /// Error of each keyframe, m; NaN if unknown.
    pub errors_m: Vec<f64>,
}

/// The choices that a recording offers for an option.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Offer {
    /// Name of the option: `scan-topic`.
    pub option: String,
    /// The current choice; empty if there is none.
    pub taken: String,
    /// The possible choices.
    pub names: Vec<String>,
}

/// A part of the worker's state that has changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum MapperReport {
    /// The file.
    File {
        /// Its name.
        name: String,
        /// Whether there are scans; a graph from a file has none.
        has_scans: bool,
    },
    /// What the worker has done.
    Progress(MapperProgress),
    /// The keyframes in order.
    Keyframes(Vec<KeyframeReport>),
    /// The map.
    Map(MapReport),
    /// The loops, the least certain first.
    Loops(Vec<LoopReport>),
    /// Doubts about the result.
    Doubts {
        /// A sentence each.
        sentences: Vec<String>,
        /// Keyframes to check.
        keyframes: Vec<usize>,
    },
    /// Remarks for the owner of the log, a sentence each.
    Remarks(Vec<String>),
    /// The scan of the keyframe that was asked for.
    Scan(ScanReport),
    /// The errors against a reference.
    Grade(GradeReport),
    /// The choices for the options of a recording.
    Offers(Vec<Offer>),
    /// The robot of another log on this map.
    OtherLog(OtherLog),
    /// The reply to the last order.
    Answer(String),
}

impl MapperReport {
    /// The name of its kind: a report replaces an earlier one of the same kind.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::File { .. } => "file",
            Self::Progress(_) => "progress",
            Self::Keyframes(_) => "keyframes",
            Self::Map(_) => "map",
            Self::Loops(_) => "loops",
            Self::Doubts { .. } => "doubts",
            Self::Remarks(_) => "remarks",
            Self::Scan(_) => "scan",
            Self::Grade(_) => "grade",
            Self::Offers(_) => "offers",
            Self::OtherLog(_) => "where",
            Self::Answer(_) => "answer",
        }
    }

    /// The report as bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        postcard::to_stdvec(self).expect("lengths are known")
    }

    /// Reads a report; `None` if the bytes are not one.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        postcard::from_bytes(bytes).ok()
    }
}
