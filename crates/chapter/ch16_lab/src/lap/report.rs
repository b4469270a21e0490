//! The report of a tick of the lap, compared with the truth.

use ch16_slam2d::loops::LoopVerification;
use pr_geom::SE2;
use pr_sim::VelocityCommand;
use serde::Serialize;

use super::{Change, Registration};

/// A keyframe: a node of the graph and its sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedKeyframe {
    /// Number of its node.
    pub node: usize,
    /// The tick after which it was taken; 0 is the start.
    pub tick: usize,
    /// True pose, world frame: for the metrics only.
    pub truth: SE2,
}

/// A sweep of the local map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedWindowScan {
    /// The tick of the sweep; 0 is the start.
    pub tick: usize,
    /// Estimated pose of the sweep: `world_from_body`.
    pub pose: SE2,
}

/// The effect of closing a loop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RecordedLoopEffect {
    /// Newest node's pose after the optimization ∘ inverse of its pose before it: the correction of the
    /// estimate and of the window.
    pub correction: SE2,
    /// Largest displacement of a node, m.
    pub max_shift_m: f64,
    /// Iterations of the optimizer.
    pub iterations: usize,
    /// χ² of the graph with the new edge, before and after the optimization.
    pub chi2: Change,
    /// Root mean square position error of the keyframes before and after, m.
    pub keyframe_rms_m: Change,
}

/// An attempt to close a loop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RecordedLoopAttempt {
    /// The tick of the attempt, counted from 1.
    pub tick: usize,
    /// Candidate, registration and tests.
    pub verification: LoopVerification,
    /// Its effect on the graph; `None` if it was rejected.
    pub effect: Option<RecordedLoopEffect>,
}

impl RecordedLoopAttempt {
    /// Whether the loop was closed.
    #[must_use]
    pub fn accepted(&self) -> bool {
        self.effect.is_some()
    }
}

/// The metrics after a tick; all errors against the simulated truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TickMetrics {
    /// Position error of dead reckoning, m.
    pub odometry_error_m: f64,
    /// Position error of the estimate, m.
    pub estimate_error_m: f64,
    /// Root mean square of the dead reckoning error over the ticks so far, m.
    pub odometry_rms_m: f64,
    /// Root mean square position error of the keyframes at their present poses, m.
    pub keyframe_rms_m: f64,
    /// Position error of the newest keyframe at its present pose, m.
    pub keyframe_error_m: f64,
    /// Map self-disagreement so far, m; `None` before the return path has a keyframe.
    pub map_disagreement_m: Option<f64>,
    /// χ² of the graph.
    pub chi2: f64,
}

/// Everything about one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TickReport {
    /// Number of the tick, counted from 1.
    pub tick: usize,
    /// Time at its end, s.
    pub time_s: f64,
    /// The command during the tick.
    pub command: VelocityCommand,
    /// True pose after the tick, world frame.
    pub truth: SE2,
    /// Dead reckoning after the tick, world frame.
    pub dead_reckoning: SE2,
    /// Prediction and registration of the sweep.
    pub registration: Registration,
    /// Estimate at the end of the tick, with the correction of a loop: `world_from_body`.
    pub estimate: SE2,
    /// Node of the new keyframe.
    pub new_keyframe: Option<usize>,
    /// The decisive attempt to close a loop: the one that was closed, or else the best.
    pub loop_attempt: Option<RecordedLoopAttempt>,
    /// Errors and map quality.
    pub metrics: TickMetrics,
    /// Whether the lap is finished.
    pub finished: bool,
}
