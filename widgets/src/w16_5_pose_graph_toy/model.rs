//! The state of the toy: the poses set by the reader, and the solver's steps from there.
//!
//! Everything is computed at once: a graph of six poses takes microseconds.

mod course;
mod hands;
mod picture;
mod settings;
mod tables;
mod words;

use kit::model::{
    Activity, Handle, Model, Motion, Outcome, Table, Timeline, TimelineMark, press_preset,
};
use kit::param::MORE;
use kit::param::ParamError;
use kit::playback::SPEED;
use kit::played::{Played, Pressed};
use kit::scene::Scene;
use kit::spec::WidgetSpec;
use kit::values::{Changed, Values};

use crate::w16_5_pose_graph_toy::spec::{PARAMS, SPEC, STEPS};
use course::{Course, Moment};

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

/// The model of the widget.
pub struct PoseGraphToy {
    values: Values,
    course: Course,
    played: Played,
}

impl Default for PoseGraphToy {
    /// The chapter's three poses, before the first step.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        Self {
            course: Course::new(settings::graph(&values)),
            values,
            played: Played::along(&STEPS),
        }
    }
}

impl PoseGraphToy {
    fn solve(&mut self) {
        self.course = Course::new(settings::graph(&self.values));
    }

    /// The current step.
    fn step(&self) -> usize {
        self.played.place(&self.values, self.course.last() as f64) as usize
    }

    fn shown(&self) -> &Moment {
        &self.course.moments[self.step()]
    }
}

impl Model for PoseGraphToy {
    fn spec(&self) -> &'static WidgetSpec {
        &SPEC
    }

    fn values(&self) -> &Values {
        &self.values
    }

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        if self.values.set(SPEC.id, id, value)? == Changed::Yes
            && ![STEPS.id, SPEED.id, MORE.id].contains(&id)
        {
            self.solve();
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let last = self.course.last() as f64;
        match self.played.press(&mut self.values, id, last) {
            Pressed::Transport => {}
            Pressed::Defaults => self.solve(),
            Pressed::Other => return press_preset(self, id),
        }
        Ok(())
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        let last = self.course.last() as f64;
        self.played
            .advance(&mut self.values, last, elapsed_s, STEPS_PER_S)
    }

    fn scene(&self) -> Scene {
        picture::scene(self)
    }

    fn outcome(&self) -> Outcome {
        words::outcome(self)
    }

    fn summary(&self) -> String {
        words::summary(self)
    }

    fn timeline(&self) -> Option<Timeline> {
        let last = self.course.last() as f64;
        Some(self.played.timeline(
            last,
            vec![TimelineMark {
                at: last,
                label: format!(
                    "at rest with χ² {:.3}",
                    self.course.moments[self.course.last()].chi2
                ),
                standing: words::standing(self),
            }],
        ))
    }

    fn tables(&self) -> Vec<Table> {
        tables::all(self)
    }

    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        hands::grab(self, panel, at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        hands::drag(self, handle, at);
    }

    fn set_motion(&mut self, motion: Motion) {
        let last = self.course.last() as f64;
        self.played.set_motion(&mut self.values, motion, last);
    }
}
