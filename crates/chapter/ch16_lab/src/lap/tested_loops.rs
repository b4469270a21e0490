//! Loop attempts of many laps as a test of hypotheses: what share of the true ones is accepted, and what share of the
//! false ones.
//!
//! The share of false loops among the accepted ones mixes both with the number of false attempts, the base rate: a test
//! that accepts true and false alike has exactly the base rate.

use super::loop_error::LoopError;
use super::record::LapTrace;
use ch16_slam2d::loops::LoopRejection;
use serde::{Deserialize, Serialize};

/// An attempt to close a loop beside the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestedLoop {
    /// Whether it passed the first test, the fit.
    pub fits: bool,
    /// χ² of the second test, the gate.
    pub chi2: f64,
    /// Whether it was closed.
    pub accepted: bool,
    /// Its error against the truth.
    pub error: LoopError,
}

impl TestedLoop {
    /// Whether it is a false loop: see [`LoopError::is_false`].
    #[must_use]
    pub fn is_false(&self) -> bool {
        self.error.is_false()
    }
}

impl LapTrace {
    /// All attempts to close a loop, in order, beside the truth.
    pub fn tested_loops(&self) -> impl Iterator<Item = TestedLoop> + '_ {
        self.loop_attempts().map(|attempt| {
            let tested = &attempt.verification;
            TestedLoop {
                fits: matches!(
                    tested.rejection,
                    None | Some(LoopRejection::OutsideGate(_) | LoopRejection::NoCovariance(_))
                ),
                chi2: tested.gate.chi2,
                accepted: attempt.accepted(),
                error: self.loop_error(attempt),
            }
        })
    }

    /// Its attempts to close a loop, true and false, and those that were accepted.
    #[must_use]
    pub fn accepted_shares(&self) -> AcceptedShares {
        let tested: Vec<_> = self.tested_loops().collect();
        AcceptedShares::of(&tested, TestedLoop::is_false, |tested| tested.accepted)
    }
}

/// Accepted attempts beside all attempts, of the true loops and of the false ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AcceptedShares {
    /// Accepted, and all.
    pub of_true: [usize; 2],
    /// Accepted, and all.
    pub of_false: [usize; 2],
}

impl AcceptedShares {
    /// Counts attempts; `accepts` is the test.
    #[must_use]
    pub fn of<'a, T: 'a>(
        loops: impl IntoIterator<Item = &'a T>,
        is_false: impl Fn(&T) -> bool,
        accepts: impl Fn(&T) -> bool,
    ) -> Self {
        let mut shares = Self::default();
        for tested in loops {
            let [accepted, all] = if is_false(tested) {
                &mut shares.of_false
            } else {
                &mut shares.of_true
            };
            *accepted += usize::from(accepts(tested));
            *all += 1;
        }
        shares
    }

    /// The counts of both.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let sum = |a: [usize; 2], b: [usize; 2]| [a[0] + b[0], a[1] + b[1]];
        Self {
            of_true: sum(self.of_true, other.of_true),
            of_false: sum(self.of_false, other.of_false),
        }
    }

    /// Shares of the true and of the false attempts that were accepted; NaN without attempts.
    #[must_use]
    pub fn rates(&self) -> [f64; 2] {
        [self.of_true, self.of_false].map(|[accepted, all]| accepted as f64 / all as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_test_that_ignores_the_truth_has_equal_rates_and_the_base_rate_among_the_accepted() {
        let attempt = |position_m: f64, chi2: f64| TestedLoop {
            fits: true,
            chi2,
            accepted: true,
            error: LoopError {
                position_m,
                heading_deg: 0.0,
            },
        };
        // One in four is false, and χ² is independent of that.
        let loops: Vec<_> = (0..400)
            .map(|k| {
                attempt(
                    if k % 4 == 0 { 0.5 } else { 0.1 },
                    f64::from(k / 4).rem_euclid(10.0),
                )
            })
            .collect();
        let shares = AcceptedShares::of(&loops, TestedLoop::is_false, |tested| tested.chi2 < 6.0);
        assert_eq!(shares.rates(), [0.6, 0.6]);
        let among_accepted =
            shares.of_false[0] as f64 / (shares.of_false[0] + shares.of_true[0]) as f64;
        assert_eq!(among_accepted, 0.25);
    }
}
