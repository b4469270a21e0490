//! Loops with their evidence and the decisions on them.

use ch16_slam2d::loops::LoopVerification;
use log_messages::{LoopDecision, LoopReport};
use nalgebra::Matrix3;
use pr_geom::SE2;

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
    pub decision: LoopDecision,
}

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
            decision: if is_in_graph {
                LoopDecision::Closed
            } else {
                LoopDecision::Rejected
            },
        }
    }

    /// What the widget shows of it.
    #[must_use]
    pub fn report(&self) -> LoopReport {
        let found = self.found.as_ref();
        let or_nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
        LoopReport {
            new: self.new,
            old: self.old,
            share: or_nan(found.and_then(|found| found.score)),
            rmse_m: or_nan(found.map(|found| found.rmse_m)),
            points: or_nan(found.map(|found| found.inliers as f64)),
            margin: or_nan(found.and_then(|found| found.margin)),
            chi2: or_nan(self.chi2),
            gate_chi2: self.gate_chi2,
            decision: self.decision,
            reason: self.reason.clone(),
        }
    }
}
