//! How a loop looks, in every panel.

use ch16_lab::lap::LoopAttempt;
use kit::scene::{LegendEntry, Mark, Stroke, Tone};

/// The line and the mark of a loop.
pub struct LoopLook {
    /// Its line.
    pub stroke: Stroke,
    /// Its colour.
    pub tone: Tone,
    /// Where it is closed, or was to be.
    pub mark: Mark,
}

impl LoopLook {
    /// Solid and green.
    pub const ACCEPTED: Self = Self {
        stroke: Stroke::Solid,
        tone: Tone::Measurement,
        mark: Mark::Dot,
    };
    /// Hollow and in a colour of no meaning.
    pub const REFUSED: Self = Self {
        stroke: Stroke::Dotted,
        tone: Tone::Series(3),
        mark: Mark::Circle,
    };

    /// The look of an attempt.
    pub fn of(attempt: &LoopAttempt) -> Self {
        if attempt.accepted() {
            Self::ACCEPTED
        } else {
            Self::REFUSED
        }
    }

    /// Its entry in a legend.
    pub fn entry(&self, label: &str) -> LegendEntry {
        LegendEntry::marked_line(label, self.tone, self.mark, self.stroke)
    }
}
