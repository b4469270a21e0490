//! The state of the three registrations and every rule that changes it.

mod curves;
mod picture;
mod settings;
mod tables;
mod words;

use ch16_lab::moving_box::{BoxMethods, BoxScene};
use ch16_slam2d::icp::{IcpSummary, IcpTrace, IcpWorkspace};
use kit::layers::MORE;
use kit::model::{
    Activity, Handle, Model, Motion, Outcome, Table, Timeline, TimelineMark, press_preset,
};
use kit::param::{Changed, ParamError, Values};
use kit::playback::{Playback, speed_factor};
use kit::scene::Scene;
use kit::spec::{DEFAULTS, WidgetSpec};

use crate::spec::{MOST_SHARE, PARAMS, SPEC};
use curves::Curves;

/// Names of the panels.
pub mod panel {
    /// The sweeps as each method registers them, in the order of the core.
    pub const SWEEPS: [&str; 3] = ["plain", "trimmed", "huber"];
    /// Bias over the share of the box.
    pub const BIAS: &str = "bias";
}

/// Iterations a second at normal speed.
const STEPS_PER_S: f64 = 5.0;

/// One registration: how it went, and how it ended.
struct Run {
    trace: Vec<IcpTrace>,
    end: IcpSummary,
    error_m: [f64; 2],
}

/// The moving box without its picture.
pub struct MovingBox {
    values: Values,
    playback: Playback,
    workspace: IcpWorkspace,
    scene: BoxScene,
    runs: [Run; 3],
    curves: Curves,
}

impl Default for MovingBox {
    fn default() -> Self {
        Self::new()
    }
}

impl MovingBox {
    /// A fifth of the points on the box.
    #[must_use]
    pub fn new() -> Self {
        let values = Values::defaults(PARAMS);
        let mut workspace = IcpWorkspace::new();
        let (config, methods) = (settings::config(&values), settings::methods(&values));
        let scene = BoxScene::new(&config);
        Self {
            runs: register(&scene, &methods, &mut workspace),
            curves: Curves::new(methods, config.moved_m),
            playback: Playback::default(),
            values,
            workspace,
            scene,
        }
    }

    fn follow(&mut self) {
        let (config, methods) = (
            settings::config(&self.values),
            settings::methods(&self.values),
        );
        self.scene = BoxScene::new(&config);
        self.runs = register(&self.scene, &methods, &mut self.workspace);
        self.curves.follow(methods, config.moved_m);
    }

    /// Last iteration of the longest run.
    fn last(&self) -> usize {
        let lasts = self.runs.iter().map(|run| run.trace.len() - 1);
        lasts.max().unwrap_or_default()
    }

    fn iteration(&self) -> usize {
        (self.values.get("iteration") as usize).min(self.last())
    }

    /// A run at the iteration that is shown; past its end it rests.
    fn shown(&self, method: usize) -> &IcpTrace {
        let trace = &self.runs[method].trace;
        &trace[self.iteration().min(trace.len() - 1)]
    }

    /// Keeps a value that lies in its range by construction.
    fn store(&mut self, id: &str, value: f64) {
        if let Err(error) = self.values.set(SPEC.id, id, value) {
            panic!("a value of our own was refused: {error}");
        }
    }
}

fn register(scene: &BoxScene, methods: &BoxMethods, workspace: &mut IcpWorkspace) -> [Run; 3] {
    methods.configs().map(|config| {
        let end = scene.register(&config, workspace);
        Run {
            trace: workspace.trace().to_vec(),
            error_m: BoxScene::error_m(&end.pose),
            end,
        }
    })
}

impl Model for MovingBox {
    fn spec(&self) -> &'static WidgetSpec {
        &SPEC
    }

    fn values(&self) -> &Values {
        &self.values
    }

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        if self.values.set(SPEC.id, id, value)? == Changed::Yes
            && !["iteration", "speed", MORE.id].contains(&id)
        {
            self.follow();
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let (here, last) = (self.iteration() as f64, self.last() as f64);
        if let Some(position) = self.playback.press(id, here, last) {
            self.store("iteration", position);
            return Ok(());
        }
        if id != DEFAULTS.id {
            return press_preset(self, id);
        }
        self.playback.pause();
        self.values.reset();
        self.follow();
        Ok(())
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        if !self.playback.is_playing() {
            return Activity::Idle;
        }
        let rate = STEPS_PER_S * speed_factor(self.values.get("speed"));
        let (here, last) = (self.iteration() as f64, self.last() as f64);
        let next = self.playback.advance(here, last, elapsed_s, rate);
        self.store("iteration", next);
        Activity::Busy
    }

    fn work(&mut self) -> Activity {
        self.curves.work(&mut self.workspace)
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
        let last = self.last() as f64;
        Some(Timeline {
            param: "iteration",
            last,
            playing: self.playback.is_playing(),
            marks: vec![TimelineMark {
                at: last,
                label: words::verdict(self).to_owned(),
                standing: words::standing(self),
            }],
        })
    }

    fn tables(&self) -> Vec<Table> {
        tables::all(self)
    }

    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        // The line at the share that is shown.
        let away = at[0] - self.values.get("share");
        (panel == panel::BIAS && away.abs() <= reach[0]).then_some(Handle {
            panel: panel::BIAS,
            id: "share",
            offset: [away, 0.0],
        })
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        let share = (at[0] - handle.offset[0]).round();
        if share.is_finite() {
            self.playback.pause();
            self.store("share", share.clamp(0.0, MOST_SHARE));
            self.follow();
        }
    }

    fn set_motion(&mut self, motion: Motion) {
        let last = self.last() as f64;
        if let Some(end) = self.playback.set_motion(motion, last) {
            self.store("iteration", end);
        }
    }
}
