//! A frame between two parts of its step.

use pr_geom::SE2;

use super::{LoopAttempt, Registration};

/// A frame under way: registered, its loops not yet decided.
#[derive(Clone, Debug)]
pub struct PendingFrame {
    pub(super) stamp_s: f64,
    pub(super) registration: Option<Registration>,
    pub(super) new_keyframe: Option<usize>,
    pub(super) loop_attempts: Vec<LoopAttempt>,
}

impl PendingFrame {
    /// Node of the keyframe that was taken.
    #[must_use]
    pub fn new_keyframe(&self) -> Option<usize> {
        self.new_keyframe
    }

    /// Whether a loop passed its tests and will be closed.
    #[must_use]
    pub fn has_loop(&self) -> bool {
        let newest = self.loop_attempts.last();
        newest.is_some_and(|attempt| attempt.verification.accepted())
    }

    /// The same frame with its loops forgotten, as if none had been looked for.
    #[must_use]
    pub fn without_loops(mut self) -> Self {
        self.loop_attempts.clear();
        self
    }

    /// Poses of all nodes before a loop was closed in this frame.
    #[must_use]
    pub fn poses_before_loop(&self) -> Option<&[SE2]> {
        let effect = self.loop_attempts.last()?.effect.as_ref()?;
        Some(&effect.poses_before)
    }
}
