//! The error of a loop against the simulated truth, and its classification.
//!
//! The estimator has no access to it. Results, command line and widgets share this definition.

use pr_geom::SE2;

use super::record::LapTrace;
use super::report::RecordedLoopAttempt;
use ch16_slam2d::metrics::position_error_m;

/// A loop farther than this from the true relative pose is false, m.
pub const FALSE_LOOP_DISTANCE_M: f64 = 0.3;

/// A loop turned by more than this against the true relative pose is false, degrees.
pub const FALSE_LOOP_TURN_DEG: f64 = 5.0;

/// The error of a loop's relative pose against the true one.
///
/// With T the true pose of the new node in the frame of the old one and T̂ the registered one, both parts are
/// those of `T⁻¹ T̂`: the length of its translation and the size of its rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopError {
    /// Distance, m.
    pub position_m: f64,
    /// Turn in degrees, not negative.
    pub heading_deg: f64,
}

/// An attempt to close a loop, judged by the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopJudgement {
    /// Closed, and right.
    Right,
    /// Closed although it is false.
    FalseAcceptance,
    /// Rejected, right or false.
    Rejected,
}

impl LoopError {
    /// Whether it is beyond [`FALSE_LOOP_DISTANCE_M`] or [`FALSE_LOOP_TURN_DEG`].
    #[must_use]
    pub fn is_false(&self) -> bool {
        self.position_m > FALSE_LOOP_DISTANCE_M || self.heading_deg > FALSE_LOOP_TURN_DEG
    }
}

impl LapTrace {
    /// The true pose of an attempt's new node in the frame of its old node.
    ///
    /// # Panics
    /// If the lap lacks a node of the attempt.
    #[must_use]
    pub fn loop_truth(&self, attempt: &RecordedLoopAttempt) -> SE2 {
        let truth_of = |node: usize| self.keyframes[node].truth;
        let loop_ = &attempt.verification;
        truth_of(loop_.candidate.node).between(&truth_of(loop_.from_node))
    }

    /// The error of an attempt's registration.
    ///
    /// # Panics
    /// If the lap lacks a node of the attempt.
    #[must_use]
    pub fn loop_error(&self, attempt: &RecordedLoopAttempt) -> LoopError {
        let error = self
            .loop_truth(attempt)
            .between(&attempt.verification.registered);
        LoopError {
            position_m: position_error_m(&error, &SE2::identity()),
            heading_deg: error.theta().abs().to_degrees(),
        }
    }

    /// Judges an attempt by the truth.
    ///
    /// # Panics
    /// If the lap lacks a node of the attempt.
    #[must_use]
    pub fn judge(&self, attempt: &RecordedLoopAttempt) -> LoopJudgement {
        if !attempt.accepted() {
            LoopJudgement::Rejected
        } else if self.loop_error(attempt).is_false() {
            LoopJudgement::FalseAcceptance
        } else {
            LoopJudgement::Right
        }
    }

    /// The false loops that were closed.
    pub fn false_acceptances(&self) -> impl Iterator<Item = &RecordedLoopAttempt> {
        self.loop_attempts()
            .filter(|attempt| self.judge(attempt) == LoopJudgement::FalseAcceptance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lap::{LapConfig, LapRunner};

    #[test]
    fn a_loop_is_false_by_distance_or_by_turn() {
        let lap = LapRunner::new().run(&LapConfig::default()).lap;
        assert_eq!(lap.false_acceptances().count(), 0);
        let tick = lap.loop_attempts().next().unwrap().tick;
        for offset in [SE2::from_xy(0.6, 0.0), SE2::new(0.0, 0.0, 0.2)] {
            let mut wrong = lap.clone();
            let attempt = wrong.reports[tick - 1].loop_attempt.as_mut().unwrap();
            attempt.verification.registered = attempt.verification.registered * offset;
            assert_eq!(wrong.false_acceptances().count(), 1);
        }
    }

    #[test]
    fn an_attempt_is_judged_by_how_far_it_was_moved_off_the_truth() {
        let lap = LapRunner::new().run(&LapConfig::default()).lap;
        let mut attempt = *lap.loop_attempts().next().unwrap();
        // Just within and just beyond 0.3 m and 5°, to either side.
        let turn = |degrees: f64| SE2::new(0.0, 0.0, degrees.to_radians());
        for (offset, judgement) in [
            (SE2::from_xy(0.0, -0.299), LoopJudgement::Right),
            (SE2::from_xy(0.0, -0.301), LoopJudgement::FalseAcceptance),
            (turn(-4.99), LoopJudgement::Right),
            (turn(-5.01), LoopJudgement::FalseAcceptance),
            (turn(5.01), LoopJudgement::FalseAcceptance),
        ] {
            attempt.verification.registered = lap.loop_truth(&attempt) * offset;
            let error = lap.loop_error(&attempt);
            // 1e-12: rounding of one composition and its inverse, on metres and degrees of order 1.
            let turn_deg = offset.theta().abs().to_degrees();
            assert!((error.position_m - offset.y().abs()).abs() < 1e-12);
            assert!((error.heading_deg - turn_deg).abs() < 1e-12);
            assert_eq!(lap.judge(&attempt), judgement, "{error:?}");
        }
        attempt.effect = None;
        assert_eq!(lap.judge(&attempt), LoopJudgement::Rejected);
    }
}
