//! Early abandonment of attempts.

use crate::report::{StepReport, StopReason};

/// Smallest gain ratio of the first step from a good start.
///
/// On five of eight recorded graphs the first step achieves at least 0.98 of the decrease that the linear model
/// predicts, and three or four steps suffice. On the others it achieves 0.88, 0.49 and a negative share, and the
/// solve takes long or ends in a local minimum.
const MIN_FIRST_GAIN_RATIO: f64 = 0.9;

/// The first step is tested only if its predicted decrease exceeds this share of the cost. A start with less to
/// gain is close to a minimum.
const MIN_PREDICTED_DECREASE: f64 = 0.1;

/// A relative rise of at most this is rounding at a minimum.
const ROUNDING: f64 = 1e-9;

/// Smallest gain ratio at which the linear model is trusted.
const TRUSTED_GAIN_RATIO: f64 = 0.9;

/// Relative difference of costs above which two minima are different.
const DIFFERENT_MINIMUM: f64 = 1e-6;

/// The condition on which an attempt is abandoned.
#[derive(Clone, Copy, Debug)]
pub(super) enum Watch {
    /// Never: the attempt runs to its end.
    Never,
    /// Another start is available: a step that raises the cost ends the attempt, and so does a low gain ratio of
    /// the first step, for undamped steps on plain least squares.
    StopOnRise {
        /// Whether the gain ratio of the first step is tested.
        and_gain_ratio: bool,
    },
    /// An earlier attempt has converged at this cost, and this one has to end lower.
    MustBeat(f64),
}

impl Watch {
    /// A reason to abandon an attempt whose last step led to `cost`.
    pub fn judge(self, steps: &[StepReport], cost: f64) -> Option<StopReason> {
        let last = steps.last().filter(|step| step.accepted)?;
        let (predicted, actual) = (last.predicted_decrease, last.cost_before - cost);
        match self {
            Self::Never => None,
            Self::StopOnRise { and_gain_ratio } => {
                let is_tested = and_gain_ratio
                    && steps.len() == 1
                    && predicted > MIN_PREDICTED_DECREASE * last.cost_before;
                if is_tested && actual < MIN_FIRST_GAIN_RATIO * predicted {
                    Some(StopReason::LowGainRatio { predicted, actual })
                } else if cost > (1.0 + ROUNDING) * last.cost_before {
                    Some(StopReason::CostRose {
                        before: last.cost_before,
                        after: cost,
                    })
                } else {
                    None
                }
            }
            Self::MustBeat(best) => {
                let reachable_cost = last.cost_before - predicted;
                let is_trusted = last.damping == 0.0 && actual >= TRUSTED_GAIN_RATIO * predicted;
                (is_trusted && reachable_cost >= (1.0 - DIFFERENT_MINIMUM) * best).then_some(
                    StopReason::CannotImprove {
                        predicted: reachable_cost,
                        best,
                    },
                )
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

    const STOP_ON_RISE: Watch = Watch::StopOnRise {
        and_gain_ratio: true,
    };

    #[test]
    fn a_first_gain_ratio_of_one_half_ends_the_attempt() {
        let first = step(100.0, 90.0);
        assert_eq!(STOP_ON_RISE.judge(&[first], 15.0), None);
        assert_eq!(
            STOP_ON_RISE.judge(&[first], 55.0),
            Some(StopReason::LowGainRatio {
                predicted: 90.0,
                actual: 45.0
            })
        );
        // Later steps may have a lower gain ratio, and so may one with a small predicted decrease.
        assert_eq!(STOP_ON_RISE.judge(&[first, step(55.0, 50.0)], 30.0), None);
        assert_eq!(STOP_ON_RISE.judge(&[step(100.0, 5.0)], 99.0), None);
    }

    #[test]
    fn a_step_that_climbs_ends_the_attempt_if_another_start_is_available() {
        let steps = [step(100.0, 90.0), step(12.0, 5.0)];
        assert!(matches!(
            STOP_ON_RISE.judge(&steps, 13.0),
            Some(StopReason::CostRose { .. })
        ));
        assert_eq!(Watch::Never.judge(&steps, 13.0), None);
        assert_eq!(
            STOP_ON_RISE.judge(&steps, 12.0 * (1.0 + f64::EPSILON)),
            None
        );
    }

    #[test]
    fn an_attempt_that_cannot_improve_ends() {
        let steps = [step(100.0, 80.0)];
        // Its gain ratio is good and it reaches 20 at best.
        assert!(Watch::MustBeat(20.0).judge(&steps, 21.0).is_some());
        assert!(Watch::MustBeat(20.1).judge(&steps, 21.0).is_none());
        // Its gain ratio is low, so its next steps cannot be predicted.
        assert!(Watch::MustBeat(20.0).judge(&steps, 60.0).is_none());
    }
}
