//! The panels: the map, the loop from near, the plots over time.

mod closeup;
mod map;
mod plots;

use ch16_lab::lap::LoopAttempt;
use kit::scene::{LegendEntry, Mark, Scene, Stroke, Tone};

use super::moment::Moment;

pub use plots::OVER_TIME;

/// How a loop looks, in every panel.
struct LoopLook {
    stroke: Stroke,
    tone: Tone,
    mark: Mark,
}

impl LoopLook {
    /// Solid and green.
    const ACCEPTED: Self = Self {
        stroke: Stroke::Solid,
        tone: Tone::Measurement,
        mark: Mark::Dot,
    };
    /// Hollow and grey.
    const REFUSED: Self = Self {
        stroke: Stroke::Dotted,
        tone: Tone::Truth,
        mark: Mark::Circle,
    };

    fn of(attempt: &LoopAttempt) -> Self {
        if attempt.accepted() {
            Self::ACCEPTED
        } else {
            Self::REFUSED
        }
    }

    fn entry(&self, label: &str) -> LegendEntry {
        LegendEntry::marked_line(label, self.tone, self.mark, self.stroke)
    }
}

/// The whole picture.
pub fn scene(moment: &Moment) -> Scene {
    Scene {
        panels: vec![
            map::map(moment),
            closeup::closeup(moment),
            plots::errors(moment),
            plots::disagreement(moment),
            plots::gate(moment),
        ],
    }
}
