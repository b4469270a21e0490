//! The style of a loop, shared by all panels.

use ch16_lab::lap::RecordedLoopAttempt;
use widget_kit::scene::{LegendEntry, Mark, Stroke, Tone};

/// The line and the mark of a loop.
pub struct LoopStyle {
    /// Its line.
    pub stroke: Stroke,
    /// Its colour.
    pub tone: Tone,
    /// The mark of the loop.
    pub mark: Mark,
}

impl LoopStyle {
    /// Solid and green.
    pub const ACCEPTED: Self = Self {
        stroke: Stroke::Solid,
        tone: Tone::Measurement,
        mark: Mark::Dot,
    };
    /// Hollow and in a colour of no meaning.
    pub const REJECTED: Self = Self {
        stroke: Stroke::Dotted,
        tone: Tone::Series(3),
        mark: Mark::Circle,
    };

    /// The style of an attempt.
    pub fn from_attempt(attempt: &RecordedLoopAttempt) -> Self {
        if attempt.accepted() {
            Self::ACCEPTED
        } else {
            Self::REJECTED
        }
    }

    /// The legend entry.
    pub fn entry(&self, label: &str) -> LegendEntry {
        LegendEntry::marked_line(label, self.tone, self.mark, self.stroke)
    }
}
