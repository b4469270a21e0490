//! What the choices of the parameters mean: the colours of the path, and which loops are shown.

use log_messages::LoopReport;

use super::log_state::LogState;

/// The quantity that colours the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// Position on the timeline.
    Time,
    /// Share of each scan that fits.
    Fit,
    /// Standard deviation of the position.
    Sigma,
    /// Error against a reference.
    Error,
}

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

/// Which loops the map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShownLoops {
    /// None.
    None,
    /// Those of the graph.
    InGraph,
    /// The rejected ones as well.
    All,
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
