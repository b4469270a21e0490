//! When an attempt is given up before it ends.

use crate::report::{StepReport, StopReason};

/// The share of its promise that the first step from a good start keeps.
///
/// The linear model promises to reach its minimum. On five of eight recorded graphs the first step
/// wins at least 0.98 of that and three or four steps suffice. On the others it wins 0.88, 0.49 and
/// less than nothing of it, and the way is long or leads to a false minimum.
const KEPT_BY_A_GOOD_START: f64 = 0.9;

/// A first step is judged where it promises more than this share of the cost. A start that has less
/// to win is close to a minimum.
const WORTH_JUDGING: f64 = 0.1;

/// A rise that is no more than this, relative, is rounding at a minimum.
const ROUNDING: f64 = 1e-9;

/// The share of its promise that a step keeps where the linear model can be believed.
const BELIEVED: f64 = 0.9;

/// How much lower than the best a new minimum must lie to be another one, relative.
const ANOTHER_MINIMUM: f64 = 1e-6;

/// What is watched on the way of an attempt.
#[derive(Clone, Copy, Debug)]
pub(super) enum Watch {
    /// Nothing: the attempt goes on to its end.
    Nothing,
    /// Another start stands by: a step that climbs ends the attempt, and with plain steps on plain
    /// least squares a first step that breaks its promise.
    Climbs {
        /// Whether the first step is judged by its promise.
        and_promise: bool,
    },
    /// An attempt before has converged at this cost, and this one has to end lower.
    Beats(f64),
}

impl Watch {
    /// A reason to give up an attempt whose last step led to `cost`.
    pub fn judge(self, steps: &[StepReport], cost: f64) -> Option<StopReason> {
        let last = steps.last().filter(|step| step.accepted)?;
        let (promised, won) = (last.predicted_decrease, last.cost_before - cost);
        match self {
            Self::Nothing => None,
            Self::Climbs { and_promise } => {
                let is_judged =
                    and_promise && steps.len() == 1 && promised > WORTH_JUDGING * last.cost_before;
                if is_judged && won < KEPT_BY_A_GOOD_START * promised {
                    Some(StopReason::PromiseBroken { promised, won })
                } else if cost > (1.0 + ROUNDING) * last.cost_before {
                    Some(StopReason::CostRose {
                        before: last.cost_before,
                        after: cost,
                    })
                } else {
                    None
                }
            }
            Self::Beats(best) => {
                let reachable = last.cost_before - promised;
                let is_believed = last.damping == 0.0 && won >= BELIEVED * promised;
                (is_believed && reachable >= (1.0 - ANOTHER_MINIMUM) * best)
                    .then_some(StopReason::Hopeless { reachable, best })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(cost_before: f64, predicted_decrease: f64) -> StepReport {
        StepReport {
            chi2_before: cost_before,
            cost_before,
            largest_step: 1.0,
            predicted_decrease,
            damping: 0.0,
            accepted: true,
        }
    }

    const CLIMBS: Watch = Watch::Climbs { and_promise: true };

    #[test]
    fn a_first_step_that_wins_half_of_its_promise_ends_the_attempt() {
        let first = step(100.0, 90.0);
        assert_eq!(CLIMBS.judge(&[first], 15.0), None);
        assert_eq!(
            CLIMBS.judge(&[first], 55.0),
            Some(StopReason::PromiseBroken {
                promised: 90.0,
                won: 45.0
            })
        );
        // Later steps are free to win less, and so is one that hardly promised anything.
        assert_eq!(CLIMBS.judge(&[first, step(55.0, 50.0)], 30.0), None);
        assert_eq!(CLIMBS.judge(&[step(100.0, 5.0)], 99.0), None);
    }

    #[test]
    fn a_step_that_climbs_ends_the_attempt_where_another_start_stands_by() {
        let steps = [step(100.0, 90.0), step(12.0, 5.0)];
        assert!(matches!(
            CLIMBS.judge(&steps, 13.0),
            Some(StopReason::CostRose { .. })
        ));
        assert_eq!(Watch::Nothing.judge(&steps, 13.0), None);
        assert_eq!(CLIMBS.judge(&steps, 12.0 * (1.0 + f64::EPSILON)), None);
    }

    #[test]
    fn an_attempt_that_leads_to_what_is_found_already_is_hopeless() {
        let steps = [step(100.0, 80.0)];
        // It kept its promise and reaches 20 at best.
        assert!(Watch::Beats(20.0).judge(&steps, 21.0).is_some());
        assert!(Watch::Beats(20.1).judge(&steps, 21.0).is_none());
        // It broke its promise: who knows what the next one reaches.
        assert!(Watch::Beats(20.0).judge(&steps, 60.0).is_none());
    }
}
