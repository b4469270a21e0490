//! State and logic of the widget; no egui.
//!
//! A sweep is shifted over the map for which it was taken, with fixed heading. Every shift has ICP's
//! truncated cost and NDT's score. A ball descends from the crosshair on each landscape. The
//! relief shows one of the two, and morphs if the reader switches. Only what
//! depends on a changed parameter is computed again: see [`terrains`]. A hundred sweeps with independent
//! noise show the scatter of the results: see [`rests`].
//!
//! # Computed
//!
//! At every shift of the grid the truncated cost of ICP (the mean over the points of min(d², τ²)) and the score of NDT, by
//! the core's own lookups; no value is interpolated. The core computes the descent of the balls as well.
//!
//! # Numbers
//!
//! Scenes, noise and cells: `crates/chapter/ch16_lab/src/terrain/scene.rs`.
//!
//! # Simplified
//!
//! The heading is fixed at the truth, so a cost of three variables is shown as a cost of two. ICP's cost keeps no pairs from
//! one step to the next. Except in the long corridor the cloud is shifted over its own points, so map and sweep share
//! their noise.

mod landscape;
mod morph;
mod picture;
mod rests;
mod settings;
mod tables;
mod terrains;
mod texts;

use widget_kit::model::{Activity, Handle, Model, Motion, Outcome, Table, Timeline, press_preset};
use widget_kit::param::ParamError;
use widget_kit::playback::Playback;
use widget_kit::playback::SPEED;
use widget_kit::scene::Scene;
use widget_kit::spec::WidgetSpec;
use widget_kit::values::{Changed, Values};

use crate::w16_3_cost_terraces::spec::{
    DROPS, END_PERCENT, HALF_SPAN_M, MAX_DROPS, MEASURE, PARAMS, ROLLED, ReliefMeasure, SPEC,
};
use morph::Morph;
use picture::{Looked, PictureState};
use rests::Rests;
use settings::TerraceSettings;
use terrains::Terrains;

/// Share of the path that the ball rolls in a second at speed ×1.
const PERCENT_PER_S: f64 = 30.0;

/// The model of the widget.
pub struct CostTerraces {
    values: Values,
    terrains: Terrains,
    rests: Rests,
    morph: Morph,
    playback: Playback,
    hover_m: Option<[f64; 2]>,
}

impl Default for CostTerraces {
    /// The widget with every parameter at its default.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        let terrains = Terrains::new(TerraceSettings::read(&values));
        Self {
            rests: Rests::new(&terrains),
            morph: Morph::new(&terrains),
            terrains,
            values,
            playback: Playback::default(),
            hover_m: None,
        }
    }
}

impl CostTerraces {
    fn settings(&self) -> TerraceSettings {
        TerraceSettings::read(&self.values)
    }

    fn measure(&self) -> ReliefMeasure {
        self.values.get(&MEASURE)
    }

    fn rolled(&self) -> f64 {
        self.values.get(&ROLLED)
    }

    fn go_to(&mut self, rolled: f64) {
        self.put("t", rolled);
    }

    /// Sets a parameter of the widget to a valid value.
    fn put(&mut self, id: &'static str, value: f64) {
        if let Err(error) = self.values.set(SPEC.id, id, value) {
            unreachable!("the widget's own value was rejected: {error}");
        }
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
        self.morph
            .turn_to(self.measure(), self.playback.motion(), &self.terrains);
    }

    fn moment(&self) -> PictureState {
        let measure = self.measure();
        let ball = &self.terrains.of(measure).ball;
        let share = self.rolled() / END_PERCENT;
        let step = (share * ball.steps() as f64).round() as usize;
        let rolls = 0 < step && step < ball.steps();
        PictureState {
            measure,
            probe_m: self.settings().probe_m,
            looked: match self.hover_m {
                Some(at) => Looked::Pointer(at),
                None if rolls => Looked::Ball,
                None => Looked::CrossHair,
            },
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
        if let Some(position) = self.playback.press(id, self.rolled(), END_PERCENT) {
            self.go_to(position);
            return Ok(());
        }
        match id {
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
        let morphing = self.morph.advance(elapsed_s, &self.terrains);
        if !self.playback.is_playing() {
            return if morphing.is_busy() { morphing } else { flying };
        }
        let rate = PERCENT_PER_S * self.values.get(&SPEED);
        let here = self.rolled();
        let next = self.playback.advance(here, END_PERCENT, elapsed_s, rate);
        self.go_to(next);
        Activity::Busy
    }

    /// Registers one more of the dropped sweeps.
    fn work(&mut self) -> Activity {
        self.rests.work(&self.terrains)
    }

    fn scene(&self) -> Scene {
        picture::scene(&self.terrains, &self.rests, &self.morph, self.moment())
    }

    fn outcome(&self) -> Outcome {
        texts::outcome(&self.terrains, &self.rests, &self.settings())
    }

    fn summary(&self) -> String {
        texts::summary(&self.terrains, &self.settings())
    }

    fn timeline(&self) -> Option<Timeline> {
        Some(Timeline {
            param: "t",
            last: END_PERCENT,
            playing: self.playback.is_playing(),
            marks: Vec::new(),
        })
    }

    fn tables(&self) -> Vec<Table> {
        tables::all(&self.terrains, &self.rests, &self.settings())
    }

    fn shown_tables(&self) -> Vec<Table> {
        tables::shown(&self.terrains)
    }

    fn grab(&self, panel: &str, at: [f64; 2], _reach: [f64; 2]) -> Option<Handle> {
        // The whole map is the target: a press anywhere moves the crosshair there.
        is_on_map(panel, at).then_some(Handle {
            panel: picture::RELIEF,
            id: "cell",
            offset: [0.0, 0.0],
            ..Handle::default()
        })
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        let onto_map =
            |axis: usize| (at[axis] - handle.offset[axis]).clamp(-HALF_SPAN_M, HALF_SPAN_M);
        let probe = [onto_map(0), onto_map(1)];
        if probe.iter().all(|value| value.is_finite()) {
            self.put("probe-x", probe[0]);
            self.put("probe-y", probe[1]);
            self.playback.pause();
            self.go_to(0.0);
            self.follow();
        }
    }

    fn plays_when_let_go(&self, _handle: &Handle) -> bool {
        true
    }

    fn hover(&mut self, panel: &str, at: Option<[f64; 2]>) {
        self.hover_m = at.filter(|at| is_on_map(panel, *at));
    }

    fn set_motion(&mut self, motion: Motion) {
        if let Some(end) = self.playback.set_motion(motion, END_PERCENT) {
            self.go_to(end);
        }
        if motion == Motion::Reduced {
            self.rests.land();
            self.morph.end(&self.terrains);
        }
    }
}

fn is_on_map(panel: &str, at: [f64; 2]) -> bool {
    panel == picture::RELIEF && at.iter().all(|value| value.abs() <= HALF_SPAN_M)
}
