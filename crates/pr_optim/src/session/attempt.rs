//! What a session tried: attempts that ended, which of them counts, and their record.

use pr_geom::SE2;

use super::Start;
use crate::kernel::RobustKernel;
use crate::report::{Report, StopReason};
use crate::settings::Method;

/// One start that a session looked at, as it tells afterwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Where it started.
    pub start: Start,
    /// With which steps.
    pub method: Method,
    /// Which cost it lowered.
    pub kernel: RobustKernel,
    /// Linear systems solved.
    pub iterations: usize,
    /// Cost at its start.
    pub cost_initial: f64,
    /// Cost at its end.
    pub cost: f64,
    /// Why it ended; `None` where it was not followed, because another guess costs less.
    pub stop: Option<StopReason>,
}

/// One attempt that ended.
#[derive(Clone, Debug)]
pub(super) struct Attempt {
    pub report: Report,
    pub start: Start,
    pub poses: Vec<SE2>,
}

impl Attempt {
    pub fn is_converged(&self) -> bool {
        self.report.stop.is_converged()
    }

    /// Whether a step on the way led uphill.
    pub fn climbed(&self) -> bool {
        let steps = self.report.steps.windows(2);
        steps
            .into_iter()
            .any(|pair| pair[1].cost_before > pair[0].cost_before)
    }

    /// The cost where it began.
    pub fn cost_initial(&self) -> f64 {
        let first = self.report.steps.first();
        first.map_or(self.report.cost, |step| step.cost_before)
    }

    /// The cost; a cost that is out of the range of numbers comes last, whatever the sign of its NaN.
    /// Information that is indefinite can make a cost negative.
    fn rank(&self) -> f64 {
        let cost = self.report.cost_or_nan();
        if cost.is_nan() { f64::INFINITY } else { cost }
    }
}

/// The lowest cost of what converged at no more than `bound`; of all where nothing did.
pub(super) fn best_of(attempts: Vec<Attempt>, bound: Option<f64>) -> Attempt {
    let is_good = |attempt: &Attempt| {
        let climbed = bound.is_some_and(|bound| attempt.report.cost > bound);
        attempt.is_converged() && !climbed
    };
    let any_good = attempts.iter().any(is_good);
    attempts
        .into_iter()
        .filter(|attempt| is_good(attempt) || !any_good)
        .min_by(|a, b| a.rank().total_cmp(&b.rank()))
        .expect("at least one attempt has ended")
}
