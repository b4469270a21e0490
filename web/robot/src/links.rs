//! Loops with their evidence and the decisions on them.

use ch16_slam2d::loops::LoopVerification;
use nalgebra::Matrix3;
use pr_geom::SE2;

/// The decision on a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Accepted by its tests, and in the graph.
    Accepted = 0,
    /// Rejected by its tests.
    Rejected = 1,
    /// Removed by the user.
    Removed = 2,
    /// Added by the user.
    Added = 3,
    /// Kept by the user although the rest of the graph contradicts it.
    Confirmed = 4,
}

impl Verdict {
    /// Whether the graph contains it.
    #[must_use]
    pub fn is_in_graph(self) -> bool {
        matches!(self, Self::Accepted | Self::Added | Self::Confirmed)
    }

    /// The opposite decision, by the user.
    #[must_use]
    pub fn toggled(self) -> Self {
        match self {
            Self::Accepted | Self::Added | Self::Confirmed => Self::Removed,
            Self::Rejected | Self::Removed => Self::Added,
        }
    }
}

/// A loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// The older keyframe, the source of the measurement.
    pub old: usize,
    /// The newer keyframe.
    pub new: usize,
    /// Pose of the newer keyframe relative to the older one.
    pub measurement: SE2,
    /// Information of the measurement.
    pub information: Matrix3<f64>,
    /// The registration; `None` in a graph file.
    pub found: Option<LoopVerification>,
    /// Squared innovation against the rest of the graph, or of the residual; `None` if unknown.
    pub chi2: Option<f64>,
    /// Gate of χ².
    pub gate_chi2: f64,
    /// Why its tests rejected it.
    pub reason: String,
    /// The decision.
    pub verdict: Verdict,
}

/// Count of numbers that [`Link::numbers`] returns.
pub const NUMBERS: usize = 10;

impl Link {
    /// Creates from a registration.
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
            reason: found.reason().unwrap_or_default(),
            verdict: if is_in_graph {
                Verdict::Accepted
            } else {
                Verdict::Rejected
            },
        }
    }

    /// Newer and older keyframe, score, RMSE (m), inliers, margin, χ², gate, verdict, and whether it
    /// was registered; NaN for unknown numbers.
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
