//! The state: one graph, and the iterations of four solvers from its start.
//!
//! Everything is computed at once: a graph of eight poses takes microseconds a step.
//!
//! # Computed
//!
//! Gauss–Newton on one ring of poses with exact, approximate and wrong Jacobians, and with a wrong residual, each to its
//! end (`ch16_lab::jacobians`).
//!
//! # Numbers
//!
//! Ring and edges: `crates/chapter/ch16_lab/src/jacobians.rs`.
//!
//! # Simplified
//!
//! Odometry turns by the same wrong amount at every edge; real errors differ from edge to edge.

mod picture;
mod settings;
mod tables;
mod texts;

use ch16_lab::jacobians::{Descent, Iterate, RingConfig, descend, optimum, ring};
use pr_geom::{SE2, math};
use widget_kit::chart::{dragged_to, grab_now};
use widget_kit::model::{Handle, Model, Timeline, TimelineMark};
use widget_kit::playback_param::{PlaybackParam, PlayedValues};
use widget_kit::values::Values;

use crate::from_modules::from_modules;
use crate::w16_12_jacobians::spec::{
    BIAS, BIAS_STEP_DEG, CURVE, LEAST_BIAS_DEG, MAX_BIAS_DEG, MAX_STEPS, PARAMS, SPEC, STEPS,
};

/// Names of the panels.
pub mod panel {
    /// The graphs of all solvers over the optimum.
    pub const GRAPHS: &str = "graphs";
    /// Distance to the optimum over the steps.
    pub const CURVE: &str = "curve";
}

/// Names of the four solvers.
pub const NAMES: [&str; 4] = ["exact", "approximate", "wrong Jacobian", "wrong residual"];

/// The first steps a second at normal speed.
const STEPS_PER_S: f64 = 3.0;
/// After so many steps the rate has doubled: later steps are too short to see.
const DOUBLED_AFTER: f64 = 5.0;

/// The model of the widget.
pub struct WrongJacobians {
    values: Values,
    solved: Solved,
    playback: PlaybackParam,
}

/// Results for the current settings.
struct Solved {
    /// The poses at the minimum of χ².
    optimum: Vec<SE2>,
    /// χ² there.
    least_chi2: f64,
    /// The iterations of each solver.
    runs: [Descent; 4],
}

impl Solved {
    fn new(values: &Values) -> Self {
        let graph = ring(&settings::ring(values));
        let (optimum, least_chi2) = optimum(&graph);
        Self {
            runs: settings::recipes(values)
                .map(|recipe| descend(&graph, recipe, &optimum, MAX_STEPS)),
            optimum,
            least_chi2,
        }
    }
}

impl Default for WrongJacobians {
    /// A ring with a contradiction of 6° per edge, before the first step.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        Self {
            solved: Solved::new(&values),
            values,
            playback: PlaybackParam::along(&STEPS),
        }
    }
}

impl WrongJacobians {
    /// The largest number of steps of the four.
    fn last(&self) -> usize {
        let lasts = self.solved.runs.iter().map(Descent::steps);
        lasts.max().unwrap_or_default()
    }

    fn step(&self) -> usize {
        self.playback.place(&self.values, self.last() as f64) as usize
    }

    /// Whether all four have ended.
    fn is_over(&self) -> bool {
        self.step() == self.last()
    }

    /// How many steps a solver has done.
    fn steps_of(&self, solver: usize) -> usize {
        self.step().min(self.solved.runs[solver].steps())
    }

    /// The loose end of the chain, which is there to bend before the first step.
    fn loose_end(&self) -> Option<[f64; 2]> {
        let start = &self.solved.runs[0].iterates[0].poses;
        (self.step() == 0).then(|| last_position(start))
    }

    /// Bends the chain until its loose end is as near to a spot as it gets.
    fn bend(&mut self, at: [f64; 2]) {
        let steps = ((MAX_BIAS_DEG - LEAST_BIAS_DEG) / BIAS_STEP_DEG) as u32;
        let away = |bias_deg: &f64| {
            let config = RingConfig {
                turn_bias_rad: bias_deg.to_radians(),
                ..settings::ring(&self.values)
            };
            let [x, y] = last_position(ring(&config).poses());
            math::norm2(x - at[0], y - at[1])
        };
        let nearest = (0..=steps)
            .map(|step| LEAST_BIAS_DEG + f64::from(step) * BIAS_STEP_DEG)
            .min_by(|a, b| away(a).total_cmp(&away(b)));
        if let Some(bias_deg) = nearest.filter(|bias_deg| *bias_deg != self.values.get(&BIAS)) {
            self.values.put(&BIAS, bias_deg);
            self.solved = Solved::new(&self.values);
        }
    }

    /// A solver's graph at the current step, or at its last one.
    fn shown(&self, solver: usize) -> &Iterate {
        &self.solved.runs[solver].iterates[self.steps_of(solver)]
    }
}

fn last_position(poses: &[SE2]) -> [f64; 2] {
    let end = poses.last().copied().unwrap_or_default();
    [end.x(), end.y()]
}

impl Model for WrongJacobians {
    from_modules!();

    fn played(&mut self) -> Option<PlayedValues<'_>> {
        Some(PlayedValues {
            end: Some(self.last() as f64),
            steps_per_s: STEPS_PER_S * (1.0 + self.step() as f64 / DOUBLED_AFTER),
            values: &mut self.values,
            playback: &mut self.playback,
        })
    }

    fn follow(&mut self, changed: Option<&str>) {
        if changed.is_none_or(|id| ![STEPS.id, CURVE.id].contains(&id)) {
            self.solved = Solved::new(&self.values);
        }
    }

    fn timeline(&self) -> Option<Timeline> {
        let marks = self.solved.runs.iter().enumerate();
        Some(
            self.playback.timeline(
                self.last() as f64,
                // A mark ahead of the current step would give the answer away.
                marks
                    .filter(|(_, run)| run.steps() <= self.step())
                    .map(|(solver, run)| TimelineMark {
                        at: run.steps() as f64,
                        label: format!("{} ends", NAMES[solver]),
                        standing: texts::standing_of(self, solver),
                    })
                    .collect(),
            ),
        )
    }

    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        if panel == panel::GRAPHS {
            let end = self.loose_end()?;
            return Handle::within(panel::GRAPHS, BIAS.id, end, at, reach);
        }
        if panel != panel::CURVE {
            return None;
        }
        grab_now(panel::CURVE, self.step() as f64, at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        if handle.panel == panel::GRAPHS {
            self.bend([at[0] - handle.offset[0], at[1] - handle.offset[1]]);
        } else if at[0].is_finite() {
            self.playback.pause();
            self.values
                .put(&STEPS, dragged_to(handle, at).min(self.last() as f64));
        }
    }

    fn plays_when_let_go(&self, handle: &Handle) -> bool {
        handle.panel == panel::GRAPHS
    }
}
