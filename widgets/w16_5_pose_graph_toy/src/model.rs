//! The state of the toy: where the poses were put, and the steps that the solver takes from there.
//!
//! All of it is computed at once: a graph of six poses takes microseconds.

mod course;
mod hands;
mod picture;
mod settings;
mod tables;
mod words;

use kit::layers::MORE;
use kit::model::{
    Activity, Handle, Model, Motion, Outcome, Table, Timeline, TimelineMark, press_preset,
};
use kit::param::{Changed, ParamError, Values};
use kit::playback::{Playback, speed_factor};
use kit::scene::Scene;
use kit::spec::{DEFAULTS, WidgetSpec};

use crate::spec::{PARAMS, SPEC};
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

/// The pose-graph toy.
pub struct PoseGraphToy {
    values: Values,
    course: Course,
    playback: Playback,
}

impl Default for PoseGraphToy {
    fn default() -> Self {
        Self::new()
    }
}

impl PoseGraphToy {
    /// The chapter's three poses, before the first step.
    #[must_use]
    pub fn new() -> Self {
        let values = Values::defaults(PARAMS);
        Self {
            course: Course::new(settings::graph(&values)),
            values,
            playback: Playback::default(),
        }
    }

    fn solve(&mut self) {
        self.course = Course::new(settings::graph(&self.values));
    }

    /// Steps done.
    fn step(&self) -> usize {
        (self.values.get("steps") as usize).min(self.course.last())
    }

    fn shown(&self) -> &Moment {
        &self.course.moments[self.step()]
    }

    /// Keeps a value that lies in its range by construction.
    fn store(&mut self, id: &str, value: f64) {
        if let Err(error) = self.values.set(SPEC.id, id, value) {
            panic!("a value of our own was refused: {error}");
        }
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
            && !["steps", "speed", MORE.id].contains(&id)
        {
            self.solve();
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let (here, last) = (self.step() as f64, self.course.last() as f64);
        if let Some(position) = self.playback.press(id, here, last) {
            self.store("steps", position);
            return Ok(());
        }
        if id != DEFAULTS.id {
            return press_preset(self, id);
        }
        self.playback.pause();
        self.values.reset();
        self.solve();
        Ok(())
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        if !self.playback.is_playing() {
            return Activity::Idle;
        }
        let rate = STEPS_PER_S * speed_factor(self.values.get("speed"));
        let (here, last) = (self.step() as f64, self.course.last() as f64);
        let next = self.playback.advance(here, last, elapsed_s, rate);
        self.store("steps", next);
        Activity::Busy
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
        Some(Timeline {
            param: "steps",
            last,
            playing: self.playback.is_playing(),
            marks: vec![TimelineMark {
                at: last,
                label: format!(
                    "at rest with χ² {:.3}",
                    self.course.moments[self.course.last()].chi2
                ),
                standing: words::standing(self),
            }],
        })
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
        if let Some(end) = self.playback.set_motion(motion, last) {
            self.store("steps", end);
        }
    }
}
