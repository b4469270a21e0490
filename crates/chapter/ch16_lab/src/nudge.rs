//! A lap and its twin with a start that differs by rounding.
//!
//! A lap is reproducible to the bit: the same configuration gives the same poses on every machine. It is a
//! single random sample all the same. Registration pairs points and selects, so a start that differs in its
//! last digits may pair one point differently, and the laps diverge. The digits of a single lap's error are
//! not a property of the method.

use ch16_slam2d::metrics::position_error_m;
use pr_geom::SE2;

use crate::lap::{LapConfig, LapRecord};

/// Relative change of the twin's start: two units of its last digit.
pub const NUDGE: f64 = 4e-16;

/// A keyframe that moved by more than this differs by more than rounding, m.
pub const CHANGED_M: f64 = 1e-6;

/// The same lap with the x of its start changed by `share` of its value, along the corridor.
///
/// Not across: at its waypoint the robot turns round by exactly π. Off the line it turns in the other
/// direction, and every lap is another drive.
#[must_use]
pub fn nudged(config: &LapConfig, share: f64) -> LapConfig {
    let mut twin = config.clone();
    let start = config.drive.start;
    twin.drive.start = SE2::new((1.0 + share) * start.x(), start.y(), start.theta());
    twin
}

/// Largest distance between the same keyframe of a lap and its twin, m.
///
/// Keyframes that only one of them has do not count.
#[must_use]
pub fn farthest_keyframe_m(lap: &LapRecord, twin: &LapRecord) -> f64 {
    let last = |record: &LapRecord| record.lap.poses(record.ticks()).to_vec();
    let pairs = last(lap).into_iter().zip(last(twin));
    pairs
        .map(|(a, b)| position_error_m(&a, &b))
        .fold(0.0, f64::max)
}

/// Distances between many laps and their twins.
#[derive(Clone, Debug, PartialEq)]
pub struct NudgeStatistics {
    /// [`farthest_keyframe_m`] of every lap and its twin, in the order of their seeds.
    pub moved_m: Vec<f64>,
}

impl NudgeStatistics {
    /// Number of laps whose twin differs by more than [`CHANGED_M`].
    #[must_use]
    pub fn changed(&self) -> usize {
        self.moved_m
            .iter()
            .filter(|&&moved| moved > CHANGED_M)
            .count()
    }

    /// The largest distance of all laps, m; 0 without laps.
    #[must_use]
    pub fn farthest_m(&self) -> f64 {
        self.moved_m.iter().copied().fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lap::LapRunner;

    #[test]
    fn the_start_moves_by_its_last_digits_only() {
        let config = LapConfig::default();
        let twin = nudged(&config, NUDGE);
        let (start, moved) = (config.drive.start, twin.drive.start);
        assert_ne!(start, moved);
        assert!(position_error_m(&start, &moved) < 3e-15);
        assert_eq!(start.theta(), moved.theta());
        assert_eq!(nudged(&config, 0.0), config);
    }

    #[test]
    fn a_lap_is_its_own_twin_to_the_bit() {
        let mut runner = LapRunner::new();
        let lap = runner.run(&LapConfig::default());
        let again = runner.run(&nudged(&LapConfig::default(), 0.0));
        assert_eq!(farthest_keyframe_m(&lap, &again), 0.0);
    }

    #[test]
    fn what_moved_is_counted_from_a_micrometre_on() {
        let moved_m = vec![0.0, 1e-7, 2e-6, 0.2];
        let statistics = NudgeStatistics { moved_m };
        assert_eq!(statistics.changed(), 2);
        assert_eq!(statistics.farthest_m(), 0.2);
    }
}
