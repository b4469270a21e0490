//! Compares the estimator's reports with the truth.

use ch16_slam2d::metrics::{DisagreementConfig, MapDisagreement, position_error_m, rms};
use ch16_slam2d::slam::{self, Slam, SlamReport};
use pr_geom::{SE2, math};

use super::report::{RecordedLoopAttempt, RecordedLoopEffect, TickMetrics, TickReport};
use super::{Change, Drive};

/// Accumulates the errors tick by tick.
///
/// The estimator has no access to it. The map's disagreement compares the path up to the drive's turn with
/// the path after it.
#[derive(Clone, Debug)]
pub struct Judge {
    turn_node: Option<usize>,
    keyframes: usize,
    disagreement: MapDisagreement,
    odometry_squares_m2: f64,
}

impl Default for Judge {
    fn default() -> Self {
        Self::new()
    }
}

impl Judge {
    /// Starts with the first frame.
    #[must_use]
    pub fn new() -> Self {
        Self {
            turn_node: None,
            keyframes: 1,
            disagreement: MapDisagreement::new(DisagreementConfig::default()),
            odometry_squares_m2: 0.0,
        }
    }

    /// The newest keyframe's node when the drive reached its turn.
    #[must_use]
    pub fn turn_node(&self) -> Option<usize> {
        self.turn_node
    }

    /// Judges the report of a tick, with the state of `slam` after it, on the frames of `drive`.
    ///
    /// # Panics
    /// If the report is that of the first frame, which is no tick, or of another drive.
    pub fn judge(&mut self, report: &SlamReport, slam: &Slam, drive: &Drive) -> TickReport {
        let tick = report.frame;
        let driven = &drive.ticks()[tick - 1];
        let loop_attempt = self.loop_attempt(report, slam, drive);
        let turn = drive.config().turn;
        let turned = turn.is_some() && driven.reached == turn;
        self.compare_maps(report, slam, turned);
        self.keyframes = slam.keyframes().len();

        let poses = slam.graph().poses();
        let newest = self.keyframes - 1;
        let newest_truth = drive.truth(slam.keyframes()[newest].frame);
        let odometry_error_m = position_error_m(&driven.dead_reckoning, &driven.truth);
        self.odometry_squares_m2 += odometry_error_m * odometry_error_m;
        TickReport {
            tick,
            time_s: report.stamp_s,
            command: driven.command,
            truth: driven.truth,
            dead_reckoning: driven.dead_reckoning,
            registration: report.registration.expect("a tick has a frame before it"),
            estimate: report.estimate,
            new_keyframe: report.new_keyframe,
            loop_attempt,
            metrics: TickMetrics {
                odometry_error_m,
                estimate_error_m: position_error_m(&report.estimate, &driven.truth),
                odometry_rms_m: math::sqrt(self.odometry_squares_m2 / tick as f64),
                keyframe_rms_m: rms(keyframe_errors_m(poses, slam.keyframes(), drive)),
                keyframe_error_m: position_error_m(&poses[newest], &newest_truth),
                map_disagreement_m: self.disagreement.value_m(),
                chi2: report.chi2,
            },
            finished: tick == drive.ticks().len(),
        }
    }

    /// The decisive attempt: the closed one, or else the best candidate.
    fn loop_attempt(
        &self,
        report: &SlamReport,
        slam: &Slam,
        drive: &Drive,
    ) -> Option<RecordedLoopAttempt> {
        let attempts = &report.loop_attempts;
        let closed = attempts.iter().find(|attempt| attempt.accepted());
        let decisive = closed.or(attempts.first())?;
        let rms_m = |poses: &[SE2]| rms(keyframe_errors_m(poses, slam.keyframes(), drive));
        Some(RecordedLoopAttempt {
            tick: decisive.frame,
            verification: decisive.verification,
            effect: decisive.effect.as_ref().map(|effect| RecordedLoopEffect {
                correction: effect.correction,
                max_shift_m: effect.max_shift_m,
                iterations: effect.iterations,
                chi2: effect.chi2,
                keyframe_rms_m: Change {
                    before: rms_m(&effect.poses_before),
                    after: rms_m(slam.graph().poses()),
                },
            }),
        })
    }

    fn compare_maps(&mut self, report: &SlamReport, slam: &Slam, turned: bool) {
        if turned {
            // The newest keyframe before this tick's.
            self.turn_node = Some(self.keyframes - 1);
        }
        let Some(turn_node) = self.turn_node else {
            return;
        };
        let (poses, keyframes) = (slam.graph().poses(), slam.keyframes());
        let first = if turned || report.closed_loop().is_some() {
            let way_out = keyframes[..=turn_node]
                .iter()
                .map(|keyframe| &*keyframe.scan);
            self.disagreement.start(poses.iter().zip(way_out));
            turn_node + 1
        } else {
            self.keyframes
        };
        for node in first..keyframes.len() {
            self.disagreement
                .compare(&poses[node], &keyframes[node].scan);
        }
    }
}

/// Position errors of keyframes at these poses, m.
pub(super) fn keyframe_errors_m<'a>(
    poses: &'a [SE2],
    keyframes: &'a [slam::Keyframe],
    drive: &'a Drive,
) -> impl Iterator<Item = f64> + 'a {
    let truths = keyframes.iter().map(|keyframe| drive.truth(keyframe.frame));
    poses
        .iter()
        .zip(truths)
        .map(|(pose, truth)| position_error_m(pose, &truth))
}
