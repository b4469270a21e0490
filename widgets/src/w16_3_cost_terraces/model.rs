//! State and logic of the widget; no egui.
//!
//! A sweep is shifted over the map for which it was taken, with fixed heading. Every shift has ICP's
//! truncated cost and NDT's score. Two balls descend from the cross hair, one on each landscape. Only what
//! depends on a changed parameter is computed again: see [`terrains`]. A hundred sweeps with independent
//! noise show the scatter of the results: see [`rests`].
//!
//! # Computed
//!
//! At every shift of the grid the truncated cost of ICP (the mean over the points of min(d², τ²)) and the score of NDT, by
//! the core's own lookups; no value is interpolated. The balls are descended by the core as well.
//!
//! # Numbers
//!
//! Scenes, noise and cells: `crates/ch16_lab/src/terrain/scene.rs`.
//!
//! # Simplified
//!
//! The heading is fixed at the truth, so a cost of three variables is shown as one of two. ICP's cost keeps no pairs from
//! one step to the next. Except in the long corridor the cloud is shifted over its own points, so map and sweep share
//! their noise.

mod landscape;
mod picture;
mod rests;
mod settings;
mod tables;
mod terrains;
mod texts;

use widget_kit::model::{
    Activity, Assessment, Handle, Model, Motion, Outcome, Table, Timeline, TimelineMark,
    finish_work, press_preset,
};
use widget_kit::param::ParamError;
use widget_kit::playback::Playback;
use widget_kit::playback::SPEED;
use widget_kit::scene::Scene;
use widget_kit::spec::WidgetSpec;
use widget_kit::values::{Changed, Values};

use crate::w16_3_cost_terraces::spec::{
    BALL_STEP, DROPS, HALF_SPAN_M, MAX_BALL_STEPS, MAX_DROPS, PARAMS, SPEC,
};
use picture::{Looked, Moment};
use rests::Rests;
use settings::Settings;
use terrains::Terrains;

/// Steps of the balls in a second at speed ×1.
const STEPS_PER_S: f64 = 24.0;

/// The model of the widget.
pub struct CostTerraces {
    values: Values,
    terrains: Terrains,
    rests: Rests,
    playback: Playback,
    hover_m: Option<[f64; 2]>,
}

impl Default for CostTerraces {
    /// The widget with every parameter at its default.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        let terrains = Terrains::new(Settings::read(&values));
        Self {
            rests: Rests::new(&terrains),
            terrains,
            values,
            playback: Playback::default(),
            hover_m: None,
        }
    }
}

impl CostTerraces {
    fn settings(&self) -> Settings {
        Settings::read(&self.values)
    }

    /// Position on the timeline; beyond the last step it means the end.
    fn step(&self) -> usize {
        (self.values.get(&BALL_STEP) as usize).min(self.last_step())
    }

    /// Steps until both balls stop.
    fn last_step(&self) -> usize {
        self.terrains
            .icp
            .ball
            .steps()
            .max(self.terrains.ndt.ball.steps())
    }

    /// Goes to a step; the end remains the end even if the next balls stop elsewhere.
    fn go_to(&mut self, step: f64) {
        let at_end = step >= self.last_step() as f64;
        self.put("t", if at_end { MAX_BALL_STEPS as f64 } else { step });
    }

    /// Sets a parameter of the widget to a valid value.
    fn put(&mut self, id: &'static str, value: f64) {
        if let Err(error) = self.values.set(SPEC.id, id, value) {
            unreachable!("the widget's own value was refused: {error}");
        }
    }

    fn drop_balls(&mut self) {
        self.playback.pause();
        let start = self.playback.toggle(0.0, self.last_step() as f64);
        self.go_to(start);
    }

    /// Drops the largest number of sweeps and animates them.
    fn drop_sweeps(&mut self) {
        self.put("drops", MAX_DROPS);
        self.rests.fly(MAX_DROPS as usize, self.playback.motion());
    }

    /// Recomputes what depends on the values.
    fn follow(&mut self) {
        self.terrains.update(self.settings());
        let drops = self.values.get(&DROPS);
        self.rests.follow(&self.terrains, drops);
    }

    fn moment(&self) -> Moment {
        let (ball, step) = (&self.terrains.icp.ball, self.step());
        let rolls = 0 < step && step < ball.steps();
        Moment {
            probe_m: self.settings().probe_m,
            looked: match self.hover_m {
                Some(at) => Looked::Pointer(at),
                None if rolls => Looked::Ball,
                None => Looked::CrossHair,
            },
            ball_m: ball.at_step(step),
            step,
            colors: self.settings().colors,
        }
    }
}

impl Model for CostTerraces {
    fn spec(&self) -> &'static WidgetSpec {
        &SPEC
    }

    fn values(&self) -> &Values {
        &self.values
    }

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        if self.values.set(SPEC.id, id, value)? == Changed::Yes {
            self.follow();
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let (here, last) = (self.step() as f64, self.last_step() as f64);
        if let Some(position) = self.playback.press(id, here, last) {
            self.go_to(position);
            return Ok(());
        }
        match id {
            "drop" => self.drop_balls(),
            "drop-100" => self.drop_sweeps(),
            "defaults" => {
                self.playback.pause();
                self.values.reset();
                self.follow();
            }
            _ => return press_preset(self, id),
        }
        Ok(())
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        let flying = self.rests.advance(elapsed_s);
        if !self.playback.is_playing() {
            return flying;
        }
        let rate = STEPS_PER_S * self.values.get(&SPEED);
        let last = self.last_step() as f64;
        let next = self
            .playback
            .advance(self.step() as f64, last, elapsed_s, rate);
        self.go_to(next);
        Activity::Busy
    }

    /// Registers one more of the dropped sweeps.
    fn work(&mut self) -> Activity {
        self.rests.work(&self.terrains)
    }

    fn finish_work(&mut self) -> Activity {
        finish_work(self)
    }

    fn scene(&self) -> Scene {
        picture::scene(&self.terrains, &self.rests, self.moment())
    }

    fn outcome(&self) -> Outcome {
        texts::outcome(&self.terrains, &self.rests, &self.settings())
    }

    fn summary(&self) -> String {
        texts::summary(&self.terrains, &self.rests, &self.settings())
    }

    fn timeline(&self) -> Option<Timeline> {
        let mark = |name: &str, steps: usize| TimelineMark {
            at: steps as f64,
            label: format!("{name} ball rests"),
            standing: Assessment::Neutral,
        };
        Some(Timeline {
            param: "t",
            last: self.last_step() as f64,
            playing: self.playback.is_playing(),
            marks: vec![
                mark("ICP", self.terrains.icp.ball.steps()),
                mark("NDT", self.terrains.ndt.ball.steps()),
            ],
        })
    }

    fn tables(&self) -> Vec<Table> {
        tables::all(&self.terrains, &self.rests, &self.settings())
    }

    fn shown_tables(&self) -> Vec<Table> {
        tables::shown(&self.terrains)
    }

    fn grab(&self, panel: &str, at: [f64; 2], _reach: [f64; 2]) -> Option<Handle> {
        let panel = map_id(panel)?;
        // The whole map is the target: a press anywhere moves the cross hair there.
        is_on_map(at).then_some(Handle {
            panel,
            id: "cell",
            offset: [0.0, 0.0],
        })
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        let onto_map =
            |axis: usize| (at[axis] - handle.offset[axis]).clamp(-HALF_SPAN_M, HALF_SPAN_M);
        let probe = [onto_map(0), onto_map(1)];
        if probe.iter().all(|value| value.is_finite()) {
            self.put("probe-x", probe[0]);
            self.put("probe-y", probe[1]);
            self.follow();
        }
    }

    fn hover(&mut self, panel: &str, at: Option<[f64; 2]>) {
        self.hover_m = at.filter(|at| map_id(panel).is_some() && is_on_map(*at));
    }

    fn set_motion(&mut self, motion: Motion) {
        if let Some(end) = self.playback.set_motion(motion, self.last_step() as f64) {
            self.go_to(end);
        }
        if motion == Motion::Reduced {
            self.rests.land();
        }
    }
}

fn map_id(panel: &str) -> Option<&'static str> {
    ["icp", "ndt"].into_iter().find(|id| *id == panel)
}

fn is_on_map(at: [f64; 2]) -> bool {
    at.iter().all(|value| value.abs() <= HALF_SPAN_M)
}
