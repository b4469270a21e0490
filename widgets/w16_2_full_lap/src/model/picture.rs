//! The panels: the map, the loop from near, the plots over time, the strain of each edge.

mod closeup;
mod flat;
mod map;
mod parts;
mod plots;
mod strain;

use ch16_lab::lap::LoopAttempt;
use kit::scene::{LegendEntry, Mark, Scene, Stroke, Tone};

use super::moment::Moment;

pub use map::{loop_mark, shown_bounds as map_bounds};
pub use plots::{OVER_TIME, gate_mark};
pub use strain::{part_of, strain_mark};

/// Names of the panels.
pub mod panel {
    /// The world with the graph.
    pub const MAP: &str = "map";
    /// One loop from near.
    pub const LOOP: &str = "loop";
    /// χ² of each loop tried.
    pub const GATE: &str = "gate";
    /// √χ² of each edge.
    pub const STRAIN: &str = "strain";
}

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
            strain::strain(moment),
        ],
    }
}
