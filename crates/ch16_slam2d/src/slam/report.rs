//! What the estimator reports of a frame.

use std::sync::Arc;

use pr_geom::SE2;

use super::front_end::Registration;
use crate::cloud::PointCloud;
use crate::loops::LoopVerification;

/// A keyframe: a node of the graph with the scan that was taken there.
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframe {
    /// Number of its node.
    pub node: usize,
    /// Number of its frame, counted from 0.
    pub frame: usize,
    /// Time of its frame, s.
    pub stamp_s: f64,
    /// Its thinned scan with normals, body frame.
    pub scan: Arc<PointCloud>,
}

/// What closing a loop did.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopEffect {
    /// Newest node's pose after the optimization ∘ its pose before it, inverted: what moved the
    /// estimate and the window.
    pub correction: SE2,
    /// Farthest that a node moved, m.
    pub max_shift_m: f64,
    /// Iterations of the optimizer; 0 where the loop waits for one that moves the graph farther.
    pub iterations: usize,
    /// χ² of the graph with the new edge, before and after the optimization.
    pub chi2: Change,
    /// Poses of all nodes before the optimization; the graph has those after it.
    pub poses_before: Vec<SE2>,
}

/// A value before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Before.
    pub before: f64,
    /// After.
    pub after: f64,
}

/// An attempt to close a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopAttempt {
    /// The frame in which it was made.
    pub frame: usize,
    /// Candidate, registration and tests.
    pub verification: LoopVerification,
    /// What it did to the graph; `None` if it was turned away.
    pub effect: Option<LoopEffect>,
}

impl LoopAttempt {
    /// Whether the loop was closed.
    #[must_use]
    pub fn accepted(&self) -> bool {
        self.effect.is_some()
    }
}

/// What was done once no frame followed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conclusion {
    /// The last attempts to close a loop.
    pub tried: Vec<LoopAttempt>,
    /// The keyframes on earlier visits: those that were accepted are the loops of the graph now.
    pub links: Vec<LoopVerification>,
}

/// Everything that one frame did.
#[derive(Clone, Debug, PartialEq)]
pub struct SlamReport {
    /// Number of the frame, counted from 0.
    pub frame: usize,
    /// Its time, s.
    pub stamp_s: f64,
    /// Prediction and registration of the scan; `None` for the first one, which starts the map.
    pub registration: Option<Registration>,
    /// Estimate at the end of the frame, a loop's correction included: `world_from_body`.
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
