//! Describes the result of a loop attempt in words, for outcome, log and marks of the widgets.

use core::fmt;

use super::loop_error::LoopJudgement;
use super::record::LapTrace;
use super::report::RecordedLoopAttempt;
use ch16_slam2d::loops::{GateTest, LoopRejection};

impl fmt::Display for LoopJudgement {
    /// `loop accepted`, `false loop accepted` or `loop rejected`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Right => "loop accepted",
            Self::FalseAcceptance => "false loop accepted",
            Self::Rejected => "loop rejected",
        })
    }
}

impl LapTrace {
    /// `loop 29 to 7 accepted`: the result of an attempt, from its new node to its old one.
    ///
    /// # Panics
    /// If the lap lacks a node of the attempt.
    #[must_use]
    pub fn loop_headline(&self, attempt: &RecordedLoopAttempt) -> String {
        let loop_ = &attempt.verification;
        let (name, verdict) = match self.judge(attempt) {
            LoopJudgement::Right => ("loop", "accepted"),
            LoopJudgement::FalseAcceptance => ("false loop", "accepted"),
            LoopJudgement::Rejected => ("loop", "rejected"),
        };
        let (new, old) = (loop_.from_node, loop_.candidate.node);
        format!("{name} {new} to {old} {verdict}")
    }

    /// The headline with its reason: χ² against the gate, and what the loop moved or why it was rejected; for
    /// a false acceptance also its error.
    ///
    /// # Panics
    /// If the lap lacks a node of the attempt.
    #[must_use]
    pub fn loop_sentence(&self, attempt: &RecordedLoopAttempt) -> String {
        let head = self.loop_headline(attempt);
        let gate = gate_words(&attempt.verification.gate);
        if let Some(effect) = &attempt.effect {
            let moved = format!("{head}, {gate}, history moved {:.2} m", effect.max_shift_m);
            let error = self.loop_error(attempt);
            return if error.is_false() {
                let (off_m, off_deg) = (error.position_m, error.heading_deg);
                format!("{moved}: its measurement is {off_m:.2} m and {off_deg:.1}° from the truth")
            } else {
                moved
            };
        }
        match attempt.verification.rejection {
            Some(LoopRejection::OutsideGate(_)) => format!("{head}: {gate}"),
            // Nothing was registered, or nothing was there to test against.
            Some(
                why @ (LoopRejection::NoPlace { .. }
                | LoopRejection::NotRegistered(_)
                | LoopRejection::NoCovariance(_)),
            ) => format!("{head}: {why}"),
            Some(why) => format!("{head}: {gate}, but {why}"),
            None => match attempt.verification.waits {
                Some(agreement) => format!("{head}: {gate}, but {agreement}"),
                None => format!("{head}: {gate}"),
            },
        }
    }
}

fn gate_words(gate: &GateTest) -> String {
    let side = if gate.passes() { "below" } else { "above" };
    format!("chi-squared {:.2} {side} {:.3}", gate.chi2, gate.gate_chi2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lap::{LapConfig, LapRunner};
    use pr_geom::SE2;

    #[test]
    fn a_sentence_names_the_nodes_the_test_that_decided_and_what_it_measured() {
        let lap = LapRunner::new().run(&LapConfig::default()).lap;
        let mut attempt = *lap.loop_attempts().next().unwrap();
        assert_eq!(
            lap.loop_sentence(&attempt),
            "loop 29 to 7 accepted, chi-squared 4.24 below 7.815, history moved 0.24 m"
        );
        let right = attempt;
        attempt.verification.registered = lap.loop_truth(&attempt) * SE2::from_xy(0.0, 0.456);
        assert_eq!(
            lap.loop_sentence(&attempt),
            "false loop 29 to 7 accepted, chi-squared 4.24 below 7.815, history moved 0.24 m: \
             its measurement is 0.46 m and 0.0° from the truth"
        );
        attempt = right;
        attempt.effect = None;
        for (rejection, reason) in [
            (
                LoopRejection::PoorFit {
                    rmse_m: 0.1859,
                    max_rmse_m: 0.16,
                },
                "below 7.815, but the inliers' RMSE is 0.186 m, above 0.160 m",
            ),
            (
                LoopRejection::FewInliers {
                    inliers: 20,
                    min_inliers: 25,
                },
                "below 7.815, but 20 inliers, at least 25 are needed",
            ),
        ] {
            attempt.verification.rejection = Some(rejection);
            assert_eq!(
                lap.loop_sentence(&attempt),
                format!("loop 29 to 7 rejected: chi-squared 4.24 {reason}")
            );
        }
        attempt.verification.rejection = Some(LoopRejection::NoPlace {
            half_width_m: 8.25,
            min_score: 0.75,
        });
        assert_eq!(
            lap.loop_sentence(&attempt),
            "loop 29 to 7 rejected: no pose within 8.2 m has a score of at least 0.75"
        );
        attempt.verification.gate.chi2 = 8.0;
        attempt.verification.rejection =
            Some(LoopRejection::OutsideGate(attempt.verification.gate));
        assert_eq!(
            lap.loop_sentence(&attempt),
            "loop 29 to 7 rejected: chi-squared 8.00 above 7.815"
        );
    }
}
