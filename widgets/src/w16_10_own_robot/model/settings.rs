//! What the values of the parameters mean: what the way is coloured by, and which loops are shown.

use kit::values::Values;

use super::robot::{Link, Robot};

/// What the way is coloured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// Place on the timeline.
    Time,
    /// Share of each scan that fits.
    Fit,
    /// Standard deviation of the position.
    Sigma,
    /// Error against a reference.
    Error,
}

impl Colour {
    /// The one that is chosen.
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

    /// The value at each keyframe; NaN where there is none.
    pub fn values(self, robot: &Robot) -> Vec<f64> {
        let start_s = robot.keyframes.first().map_or(0.0, |first| first.stamp_s);
        let keyframes = robot.keyframes.iter().enumerate();
        keyframes
            .map(|(k, keyframe)| match self {
                Self::Time => keyframe.stamp_s - start_s,
                Self::Fit => keyframe.fit,
                Self::Sigma => keyframe.sigma_m,
                Self::Error => robot.errors_m.get(k).copied().unwrap_or(f64::NAN),
            })
            .collect()
    }
}

/// Whether a loop is shown on the map.
pub fn shows(values: &Values, link: &Link) -> bool {
    match values.number("links") as usize {
        0 => false,
        1 => link.is_in_graph(),
        _ => true,
    }
}
