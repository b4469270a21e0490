//! Odometry poses around the stamps of scans, or of a whole recording.

use std::collections::VecDeque;

use pr_geom::{SE2, math, sort_numbers};

use crate::plural::plural;
use crate::remark::{Part, Remark};

/// Most poses kept of a log that is read once: 20 s at 200 per second.
const MAX_POSES: usize = 4096;
/// A pose is valid this long before the first and after the last one, s: until the next message would have come.
const SLACK_S: f64 = 0.25;
/// Poses farther apart than this are not interpolated, s.
const LONGEST_GAP_S: f64 = 2.0;
/// The same in periods, for slow odometry.
const LONGEST_GAP_PERIODS: f64 = 10.0;

/// A step is a jump if it is longer than this (m) and faster than nine of ten steps by this factor; speeds below the
/// last value (m/s) count as that.
const JUMP: f64 = 0.5;
const JUMP_SPEEDS: f64 = 10.0;
const MIN_SPEED: f64 = 0.3;
/// Least time between poses for a speed, s.
const MIN_APART_S: f64 = 1e-3;

/// Odometry poses of the body in the order of time.
#[derive(Clone, Debug)]
pub struct OdometryPoses {
    poses: VecDeque<(f64, SE2)>,
    slack_s: f64,
    gap_s: f64,
}

impl Default for OdometryPoses {
    fn default() -> Self {
        Self {
            poses: VecDeque::new(),
            slack_s: SLACK_S,
            gap_s: LONGEST_GAP_S,
        }
    }
}

impl OdometryPoses {
    /// Takes all poses of a recording with their stamps (s), in any order; `period_s` is the usual time between two.
    /// Also returns the stamps at which odometry jumped, for example because it restarted at zero; later poses are
    /// shifted to continue the path.
    #[must_use]
    pub fn new(mut poses: Vec<(f64, SE2)>, period_s: f64) -> (Self, Vec<f64>) {
        poses.sort_by(|a, b| a.0.total_cmp(&b.0));
        poses.dedup_by(|later, first| later.0 <= first.0);
        let jumps = remove_jumps(&mut poses);
        let poses = Self {
            poses: poses.into(),
            slack_s: SLACK_S.max(1.5 * period_s),
            gap_s: LONGEST_GAP_S.max(LONGEST_GAP_PERIODS * period_s),
        };
        (poses, jumps)
    }

    /// Adds a pose; skips one that is not later than the one before.
    pub fn push(&mut self, stamp_s: f64, pose: SE2) {
        if self
            .poses
            .back()
            .is_some_and(|&(last_s, _)| stamp_s <= last_s)
        {
            return;
        }
        if self.poses.len() == MAX_POSES {
            self.poses.pop_front();
        }
        self.poses.push_back((stamp_s, pose));
    }

    /// Stamps of the first and the last pose, s.
    #[must_use]
    pub fn ends_s(&self) -> Option<(f64, f64)> {
        Some((self.poses.front()?.0, self.poses.back()?.0))
    }

    /// Whether a pose at or after this time is known.
    pub fn reaches(&self, stamp_s: f64) -> bool {
        self.poses
            .back()
            .is_some_and(|&(last_s, _)| last_s >= stamp_s)
    }

    /// The pose at a time, interpolated on the twist between its neighbours; `None` outside the known poses or in a
    /// gap.
    pub fn at(&self, stamp_s: f64) -> Option<SE2> {
        let after = self.poses.partition_point(|&(pose_s, _)| pose_s < stamp_s);
        let before = after.checked_sub(1).and_then(|k| self.poses.get(k));
        match (before, self.poses.get(after)) {
            // The same bits as in the file, not those of a twist there and back.
            (_, Some(&(after_s, after))) if after_s == stamp_s => Some(after),
            (Some(&(before_s, before)), Some(&(after_s, after))) => {
                let gap_s = after_s - before_s;
                if gap_s > self.gap_s {
                    let nearest = if stamp_s - before_s < after_s - stamp_s {
                        (stamp_s - before_s, before)
                    } else {
                        (after_s - stamp_s, after)
                    };
                    return (nearest.0 <= self.slack_s).then_some(nearest.1);
                }
                let share = (stamp_s - before_s) / gap_s;
                Some(before * SE2::exp(&(before.between(&after).log() * share)))
            }
            (Some(&(pose_s, pose)), None) | (None, Some(&(pose_s, pose))) => {
                ((stamp_s - pose_s).abs() <= self.slack_s).then_some(pose)
            }
            (None, None) => None,
        }
    }
}

/// Poses of odometry as they come: after a jump they continue the path, as in [`OdometryPoses::new`], by the speeds so far.
pub struct LivePoses {
    poses: OdometryPoses,
    moved_back: SE2,
}

impl LivePoses {
    /// Creates without poses; `period_s` is the usual time between two.
    pub fn new(period_s: f64) -> Self {
        Self {
            poses: OdometryPoses {
                slack_s: SLACK_S.max(1.5 * period_s),
                gap_s: LONGEST_GAP_S.max(LONGEST_GAP_PERIODS * period_s),
                ..OdometryPoses::default()
            },
            moved_back: SE2::identity(),
        }
    }

    /// The poses so far.
    pub fn poses(&self) -> &OdometryPoses {
        &self.poses
    }

    /// Adds a pose; skips one that is not later than the one before.
    pub fn push(&mut self, stamp_s: f64, pose: SE2) {
        if let Some(&(last_s, last)) = self.poses.poses.back()
            && stamp_s > last_s
        {
            let unmoved = self.moved_back.inverse() * last;
            let (moved, speed) = step(&[(last_s, unmoved), (stamp_s, pose)]);
            if moved > JUMP && speed > JUMP_SPEEDS * self.usual_speed().max(MIN_SPEED) {
                self.moved_back = last * pose.inverse();
            }
        }
        self.poses.push(stamp_s, self.moved_back * pose);
    }

    /// Speed that nine of ten steps so far do not exceed, m/s.
    fn usual_speed(&self) -> f64 {
        let poses: Vec<(f64, SE2)> = self.poses.poses.iter().copied().collect();
        usual_speed(&poses).unwrap_or(0.0)
    }
}

/// Length (m) and speed (m/s) of the step between two poses.
fn step(two: &[(f64, SE2)]) -> (f64, f64) {
    let motion = two[0].1.between(&two[1].1);
    let moved = math::norm2(motion.x(), motion.y());
    (moved, moved / (two[1].0 - two[0].0).max(MIN_APART_S))
}

/// Speed that nine of ten steps do not exceed, m/s, which is independent of the unit of length; `None` without a step.
fn usual_speed(poses: &[(f64, SE2)]) -> Option<f64> {
    let mut speeds: Vec<f64> = poses.windows(2).map(|two| step(two).1).collect();
    sort_numbers(&mut speeds);
    speeds.get(speeds.len() * 9 / 10).copied()
}

/// Remark on odometry that jumped at these stamps (s), if there are any.
pub fn jumps_remark(jumps: &[f64]) -> Option<Remark> {
    let first_s = jumps.first()?;
    let text = format!(
        "odometry jumps {}, first at {first_s:.2} s, as after a restart of its driver; later poses were shifted to continue the path",
        plural(jumps.len(), "time")
    );
    Some(Remark::mended(Part::Odometry, text))
}

/// Shifts the poses after each jump to continue the path; returns the stamps of the jumps, s. The poses are in the
/// order of time.
pub fn remove_jumps(poses: &mut [(f64, SE2)]) -> Vec<f64> {
    let Some(usual) = usual_speed(poses) else {
        return Vec::new();
    };
    let mut jumps = Vec::new();
    let mut moved_back = SE2::identity();
    for at in 1..poses.len() {
        let (before, after) = (poses[at - 1].1, poses[at].1);
        // The pose before was shifted already.
        let unmoved = moved_back.inverse() * before;
        let (moved, speed) = step(&[(poses[at - 1].0, unmoved), (poses[at].0, after)]);
        if moved > JUMP && speed > JUMP_SPEEDS * usual.max(MIN_SPEED) {
            jumps.push(poses[at].0);
            moved_back = before * after.inverse();
        }
        poses[at].1 = moved_back * after;
    }
    jumps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_are_interpolated_between_odometry() {
        let mut odometry = OdometryPoses::default();
        assert_eq!(odometry.at(1.0), None);
        for (stamp_s, x) in [(1.0, 0.0), (2.0, 1.0), (1.5, 9.0), (4.0, 2.0)] {
            odometry.push(stamp_s, SE2::from_xy(x, 0.0));
        }
        // The pose of 1.5 s came too late and is skipped.
        for (stamp_s, x) in [(0.9, 0.0), (1.5, 0.5), (3.0, 1.5), (4.1, 2.0)] {
            let pose = odometry.at(stamp_s).unwrap();
            assert!((pose.x() - x).abs() < 1e-12, "{stamp_s}: {}", pose.x());
        }
        assert!(odometry.reaches(4.0) && !odometry.reaches(4.1));
    }

    #[test]
    fn restarted_odometry_continues_the_path() {
        let pose = |k: u32| SE2::from_xy(5.0 + 0.1 * f64::from(k % 30), 0.0);
        let poses = (0..60).map(|k| (0.1 * f64::from(k), pose(k)));
        let (odometry, jumps) = OdometryPoses::new(poses.collect(), 0.1);
        assert_eq!(jumps.len(), 1);
        // 29 steps before and 29 after it.
        assert!((odometry.at(5.9).unwrap().x() - 10.8).abs() < 1e-9);
    }

    #[test]
    fn poses_that_come_one_by_one_continue_the_path_too() {
        let pose = |k: u32| SE2::from_xy(5.0 + 0.1 * f64::from(k % 30), 0.0);
        let mut live = LivePoses::new(0.1);
        (0..60).for_each(|k| live.push(0.1 * f64::from(k), pose(k)));
        assert!((live.poses().at(5.9).unwrap().x() - 10.8).abs() < 1e-9);
    }

    #[test]
    fn beyond_the_known_poses_and_in_a_gap_there_is_none() {
        let mut odometry = OdometryPoses::default();
        for stamp_s in [1.0, 2.0, 60.0] {
            odometry.push(stamp_s, SE2::from_xy(stamp_s, 0.0));
        }
        for stamp_s in [0.0, 30.0, 61.0] {
            assert_eq!(odometry.at(stamp_s), None, "{stamp_s}");
        }
        assert!(odometry.at(2.2).is_some() && odometry.at(59.9).is_some());
    }
}
