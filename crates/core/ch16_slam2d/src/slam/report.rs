//! Reports of the estimator.

use pr_geom::SE2;
use serde::Serialize;

use super::registrar::Registration;
use crate::loops::{LoopRejection, LoopVerification};

/// Effect of closing a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopEffect {
    /// Newest node's pose after the optimization ∘ the inverse of its pose before: the correction of the
    /// estimate and the window.
    pub correction: SE2,
    /// Largest movement of a node, m.
    pub max_shift_m: f64,
    /// Iterations of the optimizer; 0 if the optimization is postponed to the next larger correction.
    pub iterations: usize,
    /// χ² of the graph with the new edge, before and after the optimization.
    pub chi2: Change,
    /// Poses of all nodes before the optimization; the graph has those after it.
    pub poses_before: Vec<SE2>,
}

/// A value before and after.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Before.
    pub before: f64,
    /// After.
    pub after: f64,
}

/// An attempt to close a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopAttempt {
    /// The frame of the attempt.
    pub frame: usize,
    /// Candidate, registration and tests.
    pub verification: LoopVerification,
    /// Its effect on the graph; `None` if it was rejected.
    pub effect: Option<LoopEffect>,
}

impl LoopAttempt {
    /// Whether the loop was closed.
    #[must_use]
    pub fn accepted(&self) -> bool {
        self.effect.is_some()
    }
}

/// Result of ending a run.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Conclusion {
    /// The last attempts to close a loop.
    pub tried: Vec<LoopAttempt>,
    /// The links of keyframes with earlier visits; the accepted ones are now the loops of the graph.
    pub links: Vec<LoopVerification>,
    /// Why the poses do not follow the newest loops: the graph could not be optimized.
    pub unsolved: Option<LoopRejection>,
}

/// Report of one frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SlamReport {
    /// Index of the frame.
    pub frame: usize,
    /// Its time, s.
    pub stamp_s: f64,
    /// Prediction and registration of the scan; `None` for the first one, which starts the map.
    pub registration: Option<Registration>,
    /// Estimate at the end of the frame, including a loop's correction: `world_from_body`.
    pub estimate: SE2,
    /// Node of the keyframe that was taken.
    pub new_keyframe: Option<usize>,
    /// The attempts to close a loop, in order; only the last one can have been closed.
    pub loop_attempts: Vec<LoopAttempt>,
    /// χ² of the graph.
    pub chi2: f64,
}

impl SlamReport {
    /// The loop that was closed, if one was.
    #[must_use]
    pub fn closed_loop(&self) -> Option<&LoopAttempt> {
        self.loop_attempts.iter().find(|attempt| attempt.accepted())
    }
}
