//! A frame between two parts of its step.

use pr_geom::SE2;

use super::finder::TriedLoops;
use super::mapper::{Closed, Consistency};
use super::{LoopAttempt, LoopEffect, Registration};
use crate::loops::LoopVerification;

/// A registered frame whose loops are not yet decided.
#[derive(Clone, Debug)]
pub struct PendingFrame {
    pub(super) stamp_s: f64,
    pub(super) registration: Option<Registration>,
    pub(super) new_keyframe: Option<usize>,
    pub(super) loop_attempts: Vec<LoopAttempt>,
    consistency: Consistency,
    /// The effect of its loops on the graph.
    effect: Option<LoopEffect>,
}

impl PendingFrame {
    pub(super) fn new(
        stamp_s: f64,
        registration: Option<Registration>,
        new_keyframe: Option<usize>,
    ) -> Self {
        Self {
            stamp_s,
            registration,
            new_keyframe,
            loop_attempts: Vec::new(),
            consistency: Consistency::Expected,
            effect: None,
        }
    }

    /// Node of the keyframe that was taken.
    #[must_use]
    pub fn new_keyframe(&self) -> Option<usize> {
        self.new_keyframe
    }

    /// Whether a loop passed its tests and will be closed.
    #[must_use]
    pub fn has_loop(&self) -> bool {
        let mut attempts = self.loop_attempts.iter();
        attempts.any(|attempt| attempt.verification.accepted())
    }

    /// The same frame without its loops.
    #[must_use]
    pub fn without_loops(mut self) -> Self {
        self.loop_attempts.clear();
        self
    }

    /// Poses of all nodes before a loop was closed in this frame.
    #[must_use]
    pub fn poses_before_loop(&self) -> Option<&[SE2]> {
        self.effect.as_ref().map(|effect| &effect.poses_before[..])
    }

    /// Adds the attempts at loops in frame number `frame`.
    pub(super) fn add(&mut self, frame: usize, tried: TriedLoops) {
        self.consistency = tried.consistency;
        let attempts = tried.found.into_iter().map(|verification| LoopAttempt {
            frame,
            verification,
            effect: None,
        });
        self.loop_attempts.extend(attempts);
    }

    /// The loops that passed their tests.
    pub(super) fn accepted(&self) -> Vec<LoopVerification> {
        let found = self
            .loop_attempts
            .iter()
            .map(|attempt| attempt.verification);
        found.filter(LoopVerification::accepted).collect()
    }

    /// Whether they contradict the graph.
    pub(super) fn consistency(&self) -> Consistency {
        self.consistency
    }

    /// Records what became of the accepted loops.
    pub(super) fn closed(&mut self, closed: Closed) {
        let attempts = self.loop_attempts.iter_mut();
        let accepted = attempts.filter(|attempt| attempt.verification.accepted());
        for (attempt, rejection) in accepted.zip(closed.rejections) {
            attempt.verification.rejection = rejection;
            if rejection.is_none() {
                attempt.effect.clone_from(&closed.effect);
            }
        }
        self.effect = closed.effect;
    }
}
