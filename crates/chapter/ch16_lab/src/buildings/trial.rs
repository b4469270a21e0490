//! Runs the estimator on a recording and compares the result with the truth.

use ch16_slam2d::chi_squared::CHAPTER_GATE;
use ch16_slam2d::graph::EdgeKind;
use ch16_slam2d::local_map::LocalMapConfig;
use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::slam::{LoopAttempt, Slam, SlamConfig};
use nalgebra::Matrix3;
use pr_geom::SE2;

use super::recording::Recording;
use crate::lap::{FALSE_LOOP_DISTANCE_M, FALSE_LOOP_TURN_DEG};

/// Largest distance between keyframes whose relative pose is compared, m.
const NEAR_M: f64 = 2.0;
/// Step between compared keyframes.
const STEP: usize = 3;
/// Smallest number of keyframes between two visits to one location.
const REVISIT: usize = 20;

/// Loops, judged by the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TrialLoops {
    /// Right loops.
    pub right: usize,
    /// False loops: more than 0.3 m or 5° off the truth.
    pub wrong: usize,
}

/// The result of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildingRun {
    /// Loops that were tried during the drive.
    pub tried: usize,
    /// Loops that were closed.
    pub closed: TrialLoops,
    /// Loop edges of the final graph.
    pub links: TrialLoops,
    /// Mean error of the relative poses of nearby keyframes, ‖t‖, m.
    pub relation_m: f64,
    /// The largest of these errors, m.
    pub worst_relation_m: f64,
    /// Largest position error of a keyframe, relative to the first one, m.
    pub worst_m: f64,
    /// Normalized estimation error squared of every keyframe but the first; three degrees of freedom.
    pub nees: Vec<f64>,
}

impl BuildingRun {
    /// Runs the estimator to the end of the recording.
    ///
    /// # Panics
    /// If the recording has no frame.
    #[must_use]
    pub fn run(recording: &Recording, robot: LocalMapConfig, with_wheels: bool) -> Self {
        let frames = &recording.frames;
        let mut slam = estimator(recording, robot);
        let (mut tried, mut closed) = (0, TrialLoops::default());
        for number in 0..frames.len() {
            let Ok(report) = slam.step(&recording.frame(number, with_wheels)) else {
                continue;
            };
            tried += report.loop_attempts.len();
            closed.add_all(&slam, recording, &report.loop_attempts);
        }
        let concluded = slam.conclude().tried;
        tried += concluded.len();
        closed.add_all(&slam, recording, &concluded);
        let mut links = TrialLoops::default();
        for view in slam.graph().edges() {
            if view.edge.kind == EdgeKind::Loop {
                let (old, new) = (view.from.index(), view.to.index());
                let truth = truth_between(&slam, recording, old, new);
                links.add(&truth, &view.edge.measurement);
            }
        }
        let truths: Vec<SE2> = slam
            .keyframes()
            .iter()
            .map(|keyframe| frames[keyframe.frame].truth)
            .collect();
        let poses = slam.graph().poses().to_vec();
        let relations = relations_m(&poses, &truths);
        let pairs = poses.iter().zip(&truths);
        Self {
            tried,
            closed,
            links,
            relation_m: relations.iter().sum::<f64>() / relations.len().max(1) as f64,
            worst_relation_m: relations.iter().copied().fold(0.0, f64::max),
            worst_m: pairs
                .map(|(a, b)| position_error_m(a, b))
                .fold(0.0, f64::max),
            nees: nees(&mut slam, &truths),
        }
    }

    /// Share of the keyframes within their 95 % confidence region; NaN without keyframes.
    #[must_use]
    pub fn within_95(&self) -> f64 {
        let within = self.nees.iter().filter(|nees| **nees <= CHAPTER_GATE);
        within.count() as f64 / self.nees.len() as f64
    }
}

/// The estimator for a recorded log, at the true pose of the first frame.
///
/// # Panics
/// If the recording has no frame.
pub(super) fn estimator(recording: &Recording, robot: LocalMapConfig) -> Slam {
    let config = SlamConfig {
        start: recording.frames[0].truth,
        ..SlamConfig::from_local_map(robot)
    };
    Slam::new(config)
}

impl TrialLoops {
    /// Counts the loops that were closed.
    fn add_all(&mut self, slam: &Slam, recording: &Recording, attempts: &[LoopAttempt]) {
        for attempt in attempts.iter().filter(|attempt| attempt.accepted()) {
            let found = &attempt.verification;
            let (old, new) = (found.candidate.node, found.from_node);
            self.add(&truth_between(slam, recording, old, new), &found.registered);
        }
    }

    fn add(&mut self, truth: &SE2, measured: &SE2) {
        let error = truth.between(measured);
        let off_m = position_error_m(&error, &SE2::identity());
        if off_m > FALSE_LOOP_DISTANCE_M || error.theta().abs().to_degrees() > FALSE_LOOP_TURN_DEG {
            self.wrong += 1;
        } else {
            self.right += 1;
        }
    }
}

/// The true pose of keyframe `new` in the frame of `old`.
fn truth_between(slam: &Slam, recording: &Recording, old: usize, new: usize) -> SE2 {
    let truth = |node: usize| recording.frames[slam.keyframes()[node].frame].truth;
    truth(old).between(&truth(new))
}

/// Errors of the relative poses of keyframes near each other, in time or in space, m.
fn relations_m(poses: &[SE2], truths: &[SE2]) -> Vec<f64> {
    let mut errors = Vec::new();
    let pairs = (0..poses.len()).flat_map(|new| (0..new).map(move |old| (old, new)));
    for (old, new) in pairs {
        let is_step = new - old == STEP;
        let is_near = new - old >= REVISIT && position_error_m(&truths[old], &truths[new]) < NEAR_M;
        if is_step || is_near {
            let error = truths[old]
                .between(&truths[new])
                .between(&poses[old].between(&poses[new]));
            errors.push(position_error_m(&error, &SE2::identity()));
        }
    }
    errors
}

/// `eᵀ P⁻¹ e` of every keyframe but the first, with the error e and the covariance P, both in the body frame.
fn nees(slam: &mut Slam, truths: &[SE2]) -> Vec<f64> {
    let covariances: Vec<Matrix3<f64>> = slam.keyframe_covariances().unwrap_or_default();
    let poses = slam.graph().poses().iter().zip(truths);
    let pairs = poses.zip(&covariances).skip(1);
    pairs
        .map(|((pose, truth), covariance)| {
            let error = pose.between(truth).log();
            let information = covariance.try_inverse().unwrap_or_default();
            error.dot(&(information * error))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::buildings::{Kind, recorded};

    #[test]
    fn a_hallway_is_mapped_through_jumps_of_the_wheels_and_past_people() {
        let (recording, config) = recorded(Kind::Hallway, 1);
        let frames = &recording.frames;
        let last = frames.len() - 1;
        let wheels = frames[0].odometry.between(&frames[last].odometry);
        let truth = frames[0].truth.between(&frames[last].truth);
        assert!(position_error_m(&wheels, &truth) > 2.0, "the wheels alone");
        let trial = BuildingRun::run(&recording, config, true);
        assert_eq!(trial.closed.wrong, 0);
        assert!(trial.closed.right > 5);
        // Six such buildings have 0.024 m in the median, 0.030 m at most.
        assert!(trial.relation_m < 0.05, "{}", trial.relation_m);
        assert!(trial.worst_m < 1.0, "{}", trial.worst_m);
    }

    #[test]
    fn keyframes_lie_in_their_ellipsoids_and_no_loop_of_a_lap_is_false() {
        let (mut within, mut all) = (0.0, 0.0);
        for (kind, seeds) in [(Kind::Lap, 60), (Kind::RingLap, 30)] {
            let trials: Vec<BuildingRun> = (2001..2001 + seeds)
                .map(|seed| {
                    let (recording, config) = recorded(kind, seed);
                    BuildingRun::run(&recording, config, true)
                })
                .collect();
            for trial in &trials {
                let keyframes = trial.nees.len() as f64;
                within += trial.within_95() * keyframes;
                all += keyframes;
            }
            let wrong: usize = trials.iter().map(|trial| trial.closed.wrong).sum();
            assert_eq!(wrong, 0, "{kind:?}");
            // The chapter's gate closes 2,348 right loops on a thousand laps of the first kind.
            let right: usize = trials.iter().map(|trial| trial.closed.right).sum();
            assert!(right >= 2 * trials.len(), "{kind:?}: {right}");
        }
        // `docs/robots.md` has the shares of a thousand laps of each kind.
        let share = within / all;
        assert!((0.90..=0.98).contains(&share), "{share}");
    }
}
