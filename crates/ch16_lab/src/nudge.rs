//! A lap and its twin that starts a hair's breadth away.
//!
//! A lap is reproducible to the bit: the same configuration gives the same poses on every machine.
//! It is one throw of the dice all the same. Registration pairs points and decides what to keep, so
//! a start that differs in its last digits may pair one point differently, and what follows drifts
//! apart until it is another lap. No digit of a single lap's error is a property of the method.

use ch16_slam2d::metrics::position_error_m;
use pr_geom::SE2;

use crate::lap::{LapConfig, LapRecord};

/// Share of itself by which the start of the twin is moved: two units of its last digit.
pub const NUDGE: f64 = 4e-16;

/// A keyframe that ends up farther away than this is a difference that no rounding explains, m.
pub const CHANGED_M: f64 = 1e-6;

/// The same lap with the x of its start moved by `share` of itself, along the corridor.
///
/// Not across: at its way point the robot turns round by exactly π. Off the line, however little, it
/// turns the other way round, and every lap is another drive.
#[must_use]
pub fn nudged(config: &LapConfig, share: f64) -> LapConfig {
    let mut twin = config.clone();
    let start = config.drive.start;
    twin.drive.start = SE2::new((1.0 + share) * start.x(), start.y(), start.theta());
    twin
}

/// The farthest that a keyframe of one lap ends from the same one of its twin, m.
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

/// How far many laps moved with their starts.
#[derive(Clone, Debug, PartialEq)]
pub struct NudgeStatistics {
    /// [`farthest_keyframe_m`] of every lap and its twin, in the order of their seeds.
    pub moved_m: Vec<f64>,
}

impl NudgeStatistics {
    /// Laps whose twin is another lap: moved by more than [`CHANGED_M`].
    #[must_use]
    pub fn changed(&self) -> usize {
        self.moved_m
            .iter()
            .filter(|&&moved| moved > CHANGED_M)
            .count()
    }

    /// The farthest that any lap moved, m; 0 of none.
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
