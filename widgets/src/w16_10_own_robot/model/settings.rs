//! Interprets the values of the parameters: the colours of the path, and which loops are shown.

use log_messages::LoopReport;
use widget_kit::values::Values;

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
    /// The selected one.
    pub fn from_values(values: &Values) -> Self {
        match values.number("colour") as usize {
            0 => Self::Time,
            1 => Self::Fit,
            2 => Self::Sigma,
            _ => Self::Error,
        }
    }

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

/// Whether a loop is shown on the map.
pub fn shows(values: &Values, link: &LoopReport) -> bool {
    match values.number("links") as usize {
        0 => false,
        1 => link.is_in_graph(),
        _ => true,
    }
}
