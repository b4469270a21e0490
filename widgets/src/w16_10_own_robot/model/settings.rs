//! What the choices of the parameters mean: the colours of the path, and which loops are shown.

use log_messages::LoopReport;

use super::log_state::LogState;
use crate::w16_10_own_robot::spec::{Colour, ShownLoops};

impl Colour {
    /// Name of the colour bar, with its unit.
    pub fn label(self) -> &'static str {
        match self {
            Self::Time => "time (s)",
            Self::Fit => "share that fits",
            Self::Sigma => "σ (m)",
            Self::Error => "error (m)",
        }
    }

    /// The value at each keyframe; NaN if it is unknown.
    pub fn values(self, robot: &LogState) -> Vec<f64> {
        let start_s = robot.keyframes.first().map_or(0.0, |first| first.stamp_s);
        let keyframes = robot.keyframes.iter().enumerate();
        keyframes
            .map(|(k, keyframe)| match self {
                Self::Time => keyframe.stamp_s - start_s,
                Self::Fit => keyframe.fit,
                Self::Sigma => keyframe.sigma_m,
                Self::Error => robot.error_m(k),
            })
            .collect()
    }
}

impl ShownLoops {
    /// Whether a loop is shown.
    pub fn include(self, link: &LoopReport) -> bool {
        match self {
            Self::None => false,
            Self::InGraph => link.decision.is_in_graph(),
            Self::All => true,
        }
    }
}
