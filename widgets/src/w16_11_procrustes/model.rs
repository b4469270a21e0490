//! The state: the pairs, and the orthogonal matrix that is tried on them.
//!
//! # Computed
//!
//! The trace tr(M W) of every rotation and every reflection about the centroids of the pairs, and the best of each
//! (`ch16_lab::procrustes`).
//!
//! # Numbers
//!
//! Pairs: `model/settings.rs`.
//!
//! # Simplified
//!
//! At most five pairs, all given; correspondences are not estimated.

mod interaction;
mod picture;
mod settings;
mod tables;
mod texts;

use ch16_lab::procrustes::{Handedness, Pairs, Procrustes};
use widget_kit::model::{Handle, Model, Table, Timeline, TimelineMark};
use widget_kit::playback_param::{PlaybackParam, PlayedValues};
use widget_kit::values::Values;

use crate::from_modules::from_modules;
use crate::w16_11_procrustes::spec::{PARAMS, SPEC, TRIED, TURN, WHOLE_TURN_DEG};

/// Names of the panels.
pub mod panel {
    /// Both sets of points, the source transformed by the matrix.
    pub const POINTS: &str = "points";
    /// The trace over the angle.
    pub const TRACE: &str = "trace";
    /// A map transformed by the best rotation.
    pub const MAP_TURN: &str = "map-turn";
    /// The same map transformed by the best orthogonal matrix.
    pub const MAP_UNCHECKED: &str = "map-unchecked";
}

/// Degrees a second at normal speed.
const STEPS_PER_S: f64 = 60.0;

/// The model of the widget.
pub struct ProcrustesTrace {
    values: Values,
    pairs: Pairs,
    problem: Procrustes,
    playback: PlaybackParam,
    /// Whether the picture holds back which matrix fits best.
    asks: bool,
}

impl Default for ProcrustesTrace {
    /// Four corners, the second time by a sensor that hangs upside down: the unchecked map is mirrored.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        let pairs = settings::pairs(&values);
        Self {
            problem: Procrustes::new(&pairs.source, &pairs.target),
            pairs,
            values,
            playback: PlaybackParam::along(&TURN),
            asks: true,
        }
    }
}

impl ProcrustesTrace {
    /// The selected kind of matrices.
    fn tried(&self) -> Handedness {
        settings::tried(&self.values)
    }

    /// The selected angle, rad.
    fn theta_rad(&self) -> f64 {
        self.values.get(&TURN).to_radians()
    }
}

impl Model for ProcrustesTrace {
    from_modules!();

    fn played(&mut self) -> Option<PlayedValues<'_>> {
        Some(PlayedValues {
            end: Some(WHOLE_TURN_DEG),
            values: &mut self.values,
            playback: &mut self.playback,
            steps_per_s: STEPS_PER_S,
        })
    }

    fn follow(&mut self, changed: Option<&str>) {
        if changed.is_none_or(|id| ![TURN.id, TRIED.id].contains(&id)) {
            self.pairs = settings::pairs(&self.values);
            self.problem = Procrustes::new(&self.pairs.source, &self.pairs.target);
        }
    }

    fn timeline(&self) -> Option<Timeline> {
        let mark = |kind: Handedness| TimelineMark {
            at: texts::whole_degrees(self.problem.best(kind).theta_rad),
            label: format!("top of the {}", texts::plural(kind)),
            standing: texts::standing_of(&self.problem, kind),
        };
        Some(
            self.playback
                .timeline(WHOLE_TURN_DEG, vec![mark(self.tried())]),
        )
    }

    fn shown_tables(&self) -> Vec<Table> {
        vec![tables::matrices(self)]
    }

    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        interaction::grab(self, panel, at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        interaction::drag(self, handle, at);
    }

    fn plays_when_let_go(&self, handle: &Handle) -> bool {
        handle.panel == panel::POINTS
    }

    fn reveal(&mut self) {
        self.asks = false;
    }
}
