//! Ended attempts of a session, their ranking, and their record.

use pr_geom::SE2;

use super::Start;
use crate::kernel::RobustKernel;
use crate::report::{Report, StopReason};
use crate::settings::Method;

/// Record of one initial guess that a session considered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriedStart {
    /// The guess.
    pub start: Start,
    /// The method of its steps.
    pub method: Method,
    /// The cost that it minimized.
    pub kernel: RobustKernel,
    /// Linear systems solved.
    pub iterations: usize,
    /// Cost at its start.
    pub cost_initial: f64,
    /// Cost at its end.
    pub cost: f64,
    /// Why it ended; `None` if it was not followed, because another guess costs less.
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

    /// Whether a step raised the cost.
    pub fn climbed(&self) -> bool {
        let steps = self.report.steps.windows(2);
        steps
            .into_iter()
            .any(|pair| pair[1].cost_before > pair[0].cost_before)
    }

    /// The cost at its start.
    pub fn cost_initial(&self) -> f64 {
        let first = self.report.steps.first();
        first.map_or(self.report.cost, |step| step.cost_before)
    }

    /// The cost for ranking; overflow and NaN of either sign come last. Indefinite information can make a cost
    /// negative.
    fn rank(&self) -> f64 {
        let cost = self.report.cost_or_nan();
        if cost.is_nan() { f64::INFINITY } else { cost }
    }
}

/// The lowest cost among converged attempts with at most `bound`; among all if there are none.
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
