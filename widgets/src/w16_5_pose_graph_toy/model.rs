//! The state of the toy: the poses set by the reader, and the solver's steps from there.
//!
//! Everything is computed at once: a graph of six poses takes microseconds.
//!
//! # Computed
//!
//! Gauss–Newton on SE(2) (`pr_optim`), one step at a time, from the poses that the reader set. Bars and springs show
//! eᵀΩe of each edge.
//!
//! # Numbers
//!
//! Lengths and weights: `model/settings.rs`.
//!
//! # Simplified
//!
//! The measurements contradict each other by one chosen gap instead of random errors, and every edge has the same
//! diagonal form of information. A real graph has hundreds of poses.

mod course;
mod interaction;
mod picture;
mod settings;
mod tables;
mod texts;

use widget_kit::disclosure::Disclosure;
use widget_kit::model::{Handle, Model, Timeline, TimelineMark};
use widget_kit::playback_param::{PlaybackParam, PlayedValues};
use widget_kit::scene::Axis;
use widget_kit::spec::PLAY;
use widget_kit::values::Values;

use crate::from_modules::from_modules;
use crate::w16_5_pose_graph_toy::spec::{GRAPH, MAX_POSES, MOVED_IDS, PARAMS, SPEC, STEPS};
use course::{GraphState, SolverRun};
use pr_geom::SE2;

/// Names of the panels.
pub mod panel {
    /// Poses and springs.
    pub const GRAPH: &str = "graph";
    /// χ² of each spring.
    pub const BARS: &str = "bars";
    /// χ² over the steps.
    pub const STEPS: &str = "steps";
}

/// Steps a second at normal speed.
const STEPS_PER_S: f64 = 1.5;

/// Part of a beat in which the poses move; then they stand still.
const MOVING_PART: f64 = 0.6;

/// The model of the widget.
pub struct PoseGraphToy {
    values: Values,
    course: SolverRun,
    playback: PlaybackParam,
    /// The axes while something is dragged, so that they stay.
    held_axes: Option<[Axis; 2]>,
}

impl Default for PoseGraphToy {
    /// The ring before the first step.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        Self {
            course: SolverRun::new(settings::graph(&values)),
            values,
            playback: PlaybackParam::along(&STEPS),
            held_axes: None,
        }
    }
}

impl PoseGraphToy {
    /// The current step.
    fn step(&self) -> usize {
        self.playback.place(&self.values, self.course.last() as f64) as usize
    }

    fn shown(&self) -> &GraphState {
        &self.course.moments[self.step()]
    }

    /// The poses on screen: while it plays, they move from step to step, each a beat.
    fn poses(&self) -> Vec<SE2> {
        let now = &self.shown().poses;
        let Some(next) = self.course.moments.get(self.step() + 1) else {
            return now.clone();
        };
        let part = (self.playback.part() / MOVING_PART).min(1.0);
        // Starts and ends at rest.
        let share = part * part * (3.0 - 2.0 * part);
        let between = |(from, to): (&SE2, &SE2)| {
            SE2::new(
                from.x() + share * (to.x() - from.x()),
                from.y() + share * (to.y() - from.y()),
                from.theta() + share * from.between(to).theta(),
            )
        };
        now.iter().zip(&next.poses).map(between).collect()
    }
}

impl Model for PoseGraphToy {
    from_modules!();

    fn played(&mut self) -> Option<PlayedValues<'_>> {
        Some(PlayedValues {
            end: Some(self.course.last() as f64),
            values: &mut self.values,
            playback: &mut self.playback,
            steps_per_s: STEPS_PER_S,
        })
    }

    fn follow(&mut self, changed: Option<&str>) {
        if changed != Some(STEPS.id) {
            self.course = SolverRun::new(settings::graph(&self.values));
        }
    }

    fn timeline(&self) -> Option<Timeline> {
        let last = self.course.last() as f64;
        Some(self.playback.timeline(
            last,
            vec![TimelineMark {
                at: last,
                label: format!(
                    "at rest with χ² {:.3}",
                    self.course.moments[self.course.last()].chi2
                ),
                standing: texts::standing(self),
            }],
        ))
    }

    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        interaction::grab(self, panel, at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        if self.held_axes.is_none() {
            self.held_axes = Some(picture::axes(self));
        }
        interaction::drag(self, handle, at);
    }

    /// The springs pull the graph to rest.
    fn release(&mut self) {
        self.held_axes = None;
        if self.step() == 0
            && let Some(mut run) = self.played()
        {
            run.press(PLAY.id);
        }
    }

    fn disclosure(&self) -> Disclosure {
        let poses = self.values.get(&GRAPH).poses();
        match Disclosure::visible(SPEC.opening, &self.values) {
            Disclosure::All if poses < MAX_POSES => Disclosure::AllBut(&MOVED_IDS[3 * poses..]),
            layer => layer,
        }
    }
}
