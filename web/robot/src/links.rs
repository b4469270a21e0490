//! Loops with their evidence and the decisions on them.

use ch16_slam2d::loops::LoopVerification;
use nalgebra::Matrix3;
use pr_geom::SE2;

/// The decision on a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It passed its tests and is in the graph.
    Closed = 0,
    /// It failed the tests.
    Rejected = 1,
    /// The reader rejected it.
    Removed = 2,
    /// The reader added it.
    Added = 3,
}

impl Verdict {
    /// Whether it is in the graph.
    #[must_use]
    pub fn is_in_graph(self) -> bool {
        matches!(self, Self::Closed | Self::Added)
    }

    /// The verdict after the reader's opposite decision.
    #[must_use]
    pub fn turned(self) -> Self {
        match self {
            Self::Closed | Self::Added => Self::Removed,
            Self::Rejected | Self::Removed => Self::Added,
        }
    }
}

/// A loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// The older keyframe, in whose frame it was measured.
    pub old: usize,
    /// The newer keyframe.
    pub new: usize,
    /// Pose of the newer keyframe in the older one's frame.
    pub measurement: SE2,
    /// Inverse covariance of the residual.
    pub information: Matrix3<f64>,
    /// Its registration; `None` in a graph from a file.
    pub found: Option<LoopVerification>,
    /// Squared innovation against the rest of the graph, or of the residual; `None` if unknown.
    pub chi2: Option<f64>,
    /// The threshold of χ².
    pub gate_chi2: f64,
    /// Why it failed the tests.
    pub reason: String,
    /// The decision.
    pub verdict: Verdict,
}

/// Count of the numbers of [`Link::numbers`].
pub const NUMBERS: usize = 10;

impl Link {
    /// A registered loop.
    #[must_use]
    pub fn registered(found: &LoopVerification, is_in_graph: bool) -> Self {
        let chi2 = found.gate.chi2;
        Self {
            old: found.candidate.node,
            new: found.from_node,
            measurement: found.registered,
            information: found.information,
            found: Some(*found),
            chi2: chi2.is_finite().then_some(chi2),
            gate_chi2: found.gate.gate_chi2,
            reason: found
                .rejection
                .map_or_else(String::new, |why| robot_io::quality::reason(&why)),
            verdict: if is_in_graph {
                Verdict::Closed
            } else {
                Verdict::Rejected
            },
        }
    }

    /// New and old keyframe, share that fits, fit (m), points, margin, χ², gate, verdict, and whether it was
    /// registered; NaN if unknown.
    #[must_use]
    pub fn numbers(&self) -> [f64; NUMBERS] {
        let found = self.found.as_ref();
        let or_nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
        [
            self.new as f64,
            self.old as f64,
            or_nan(found.and_then(|found| found.score)),
            or_nan(found.map(|found| found.rmse_m)),
            or_nan(found.map(|found| found.inliers as f64)),
            or_nan(found.and_then(|found| found.margin)),
            or_nan(self.chi2),
            self.gate_chi2,
            f64::from(self.verdict as u8),
            f64::from(u8::from(found.is_some())),
        ]
    }
}
