//! What the wheels said around the time of the scans.

use std::collections::VecDeque;

use pr_geom::SE2;

/// So many poses of the wheels are kept: 20 s at 200 a second.
const MOST_POSES: usize = 4096;

/// The wheels' poses around the time of the scans.
#[derive(Clone, Debug, Default)]
pub struct WheelPoses {
    poses: VecDeque<(f64, SE2)>,
}

impl WheelPoses {
    /// Takes a pose; one that is not after the one before it is left out.
    pub fn push(&mut self, stamp_s: f64, pose: SE2) {
        if self
            .poses
            .back()
            .is_some_and(|&(last_s, _)| stamp_s <= last_s)
        {
            return;
        }
        if self.poses.len() == MOST_POSES {
            self.poses.pop_front();
        }
        self.poses.push_back((stamp_s, pose));
    }

    /// Whether no pose is known.
    pub fn is_empty(&self) -> bool {
        self.poses.is_empty()
    }

    /// Whether a pose at or after this time is known.
    pub fn reaches(&self, stamp_s: f64) -> bool {
        self.poses
            .back()
            .is_some_and(|&(last_s, _)| last_s >= stamp_s)
    }

    /// The pose at a time, on the twist between the poses around it; beyond them the nearest one.
    pub fn at(&self, stamp_s: f64) -> Option<SE2> {
        let after = self.poses.partition_point(|&(pose_s, _)| pose_s < stamp_s);
        let before = after.checked_sub(1).and_then(|k| self.poses.get(k));
        match (before, self.poses.get(after)) {
            (Some(&(before_s, before)), Some(&(after_s, after))) => {
                let share = (stamp_s - before_s) / (after_s - before_s);
                Some(before * SE2::exp(&(before.between(&after).log() * share)))
            }
            (Some(&(_, pose)), None) | (None, Some(&(_, pose))) => Some(pose),
            (None, None) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_two_poses_of_the_wheels_the_body_is_on_the_way() {
        let mut wheels = WheelPoses::default();
        assert_eq!(wheels.at(1.0), None);
        for (stamp_s, x) in [(1.0, 0.0), (2.0, 1.0), (1.5, 9.0), (4.0, 2.0)] {
            wheels.push(stamp_s, SE2::translation(x, 0.0));
        }
        // The pose of 1.5 s came too late and is left out.
        for (stamp_s, x) in [(0.0, 0.0), (1.5, 0.5), (3.0, 1.5), (9.0, 2.0)] {
            let pose = wheels.at(stamp_s).unwrap();
            assert!((pose.x() - x).abs() < 1e-12, "{stamp_s}: {}", pose.x());
        }
        assert!(wheels.reaches(4.0) && !wheels.reaches(4.1));
    }
}
