//! The state of the three registrations and its logic.
//!
//! # Computed
//!
//! ICP on two sweeps of room A between which a box moved, with all pairs, with the longest rejected, and with Huber's weights; and
//! the bias of each over the share of points on the box.
//!
//! # Numbers
//!
//! Box, sweeps and noise: `crates/chapter/ch16_lab/src/moving_box.rs`.
//!
//! # Simplified
//!
//! Denser beams on the box give it a chosen share of the points; a real box takes its solid angle. It jumps between
//! the sweeps and rests during each.

mod curves;
mod picture;
mod settings;
mod tables;
mod texts;

use ch16_lab::moving_box::{BoxMethods, BoxScene};
use ch16_slam2d::icp::{IcpSummary, IcpTrace, IcpWorkspace};
use widget_kit::model::{Activity, Handle, Model, Timeline, TimelineMark};
use widget_kit::playback_param::{PlaybackParam, PlayedValues};
use widget_kit::values::Values;

use crate::from_modules::from_modules;
use crate::w16_8_moving_box::spec::{
    ITERATION, MAX_ITERATIONS, MAX_SHARE, METHOD, MOVED, MOVED_M, MOVED_Y, PARAMS, SHARE, SPEC,
};
use curves::Curves;

/// Names of the panels.
pub mod panel {
    /// The room as a method registers it, with the pull of each pair.
    pub const ROOM: &str = "room";
    /// Bias over the share of the box.
    pub const BIAS: &str = "bias";
}

/// Iterations a second at normal speed.
const STEPS_PER_S: f64 = 5.0;

/// Name of the box as a draggable thing, and half its width, m: a press on the box takes it.
const BOX: &str = "box";
const BOX_REACH_M: f64 = 0.2;

/// One registration: its trace and its result.
struct Run {
    trace: Vec<IcpTrace>,
    end: IcpSummary,
    error_m: [f64; 2],
}

/// The model of the widget.
pub struct MovingBox {
    values: Values,
    playback: PlaybackParam,
    workspace: IcpWorkspace,
    scene: BoxScene,
    runs: [Run; 3],
    curves: Curves,
}

impl Default for MovingBox {
    /// A fifth of the points on the box.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        let mut workspace = IcpWorkspace::new();
        let (config, methods) = (settings::config(&values), settings::methods(&values));
        let scene = BoxScene::new(&config);
        Self {
            runs: register(&scene, &methods, &mut workspace),
            curves: Curves::new(methods, config.moved_m),
            playback: PlaybackParam::along(&ITERATION),
            values,
            workspace,
            scene,
        }
    }
}

impl MovingBox {
    /// The method on screen.
    fn method(&self) -> usize {
        self.values.get(&METHOD)
    }

    /// Last iteration of the longest run.
    fn last(&self) -> usize {
        let lasts = self.runs.iter().map(|run| run.trace.len() - 1);
        lasts.max().unwrap_or_default()
    }

    fn iteration(&self) -> usize {
        self.playback.place(&self.values, self.last() as f64) as usize
    }

    /// Whether no method has made a step, so that the picture holds back where they end.
    fn is_before(&self) -> bool {
        self.iteration() == 0
    }

    /// A run at the current iteration, or at its last one.
    fn shown(&self, method: usize) -> &IcpTrace {
        let trace = &self.runs[method].trace;
        &trace[self.iteration().min(trace.len() - 1)]
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
    from_modules!();

    fn played(&mut self) -> Option<PlayedValues<'_>> {
        Some(PlayedValues {
            end: Some(self.last() as f64),
            values: &mut self.values,
            playback: &mut self.playback,
            steps_per_s: STEPS_PER_S,
        })
    }

    fn follow(&mut self, changed: Option<&str>) {
        if changed.is_some_and(|id| [METHOD.id, ITERATION.id].contains(&id)) {
            return;
        }
        let (config, methods) = (
            settings::config(&self.values),
            settings::methods(&self.values),
        );
        self.scene = BoxScene::new(&config);
        self.runs = register(&self.scene, &methods, &mut self.workspace);
        self.curves.follow(methods, config.moved_m);
    }

    fn work(&mut self) -> Activity {
        self.curves.work(&mut self.workspace)
    }

    fn settle(&mut self) -> Activity {
        Activity::Idle
    }

    fn timeline(&self) -> Option<Timeline> {
        let last = self.last() as f64;
        Some(self.playback.timeline(
            last,
            vec![TimelineMark {
                at: last,
                label: texts::verdict(self).to_owned(),
                standing: texts::standing(self),
            }],
        ))
    }

    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        match panel {
            panel::BIAS => {
                let share = self.values.get(&SHARE);
                Handle::within(panel::BIAS, "share", [share, at[1]], at, reach)
            }
            panel::ROOM => {
                let middle = picture::box_middle(&self.scene);
                let reach = reach.map(|reach| reach.max(BOX_REACH_M));
                Handle::within(panel::ROOM, BOX, middle, at, reach)
            }
            _ => None,
        }
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        let Some(spot) = handle.spot(at) else {
            return;
        };
        self.playback.pause();
        // Where the registrations end is the answer to the drag.
        self.values.put(&ITERATION, MAX_ITERATIONS);
        if handle.id == BOX {
            let middle = picture::box_middle(&self.scene);
            // The shift in the target's frame, whose axes are the world's.
            for (axis, moved) in [&MOVED, &MOVED_Y].into_iter().enumerate() {
                let [least, most] = MOVED_M[axis];
                let moved_m = self.values.get(moved) + spot[axis] - middle[axis];
                let whole_cm = (100.0 * moved_m).round() / 100.0;
                self.values.put(moved, whole_cm.clamp(least, most));
            }
        } else {
            self.values
                .put(&SHARE, spot[0].round().clamp(0.0, MAX_SHARE));
        }
        self.follow(None);
    }
}
