//! The range of every number of a [`LapConfig`], and laps drawn from all ranges at once.
//!
//! Within these ranges a lap runs to its end with finite results, accurate or not: `ch16 sweep --random`
//! drives laps at configurations drawn here. Beyond them there is no guarantee.

use core::f64::consts::{PI, TAU};

use ch16_slam2d::chapter::InformationFrame;
use ch16_slam2d::loops::GateModel;
use ch16_slam2d::matching::{MatcherKind, NdtMatcherConfig};
use pr_geom::SE2;
use pr_sim::Rng;

use super::{LapConfig, LoopClosure};

/// The range of one number.
#[derive(Clone, Copy, Debug)]
pub struct ConfigRange {
    /// Path of the field in [`LapConfig`]; its unit is in its name or its documentation.
    pub field: &'static str,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Reads the field.
    pub get: fn(&LapConfig) -> f64,
    /// Writes the field; a count is truncated to an integer.
    pub set: fn(&mut LapConfig, f64),
}

macro_rules! number {
    ($low:expr, $high:expr, $($field:ident).+) => {
        ConfigRange {
            field: stringify!($($field).+),
            low: $low,
            high: $high,
            get: |config| config.$($field).+,
            set: |config, value| config.$($field).+ = value,
        }
    };
}

macro_rules! count {
    ($low:expr, $high:expr, $($field:ident).+) => {
        ConfigRange {
            field: stringify!($($field).+),
            low: $low,
            high: $high,
            get: |config| config.$($field).+ as f64,
            set: |config, value| config.$($field).+ = value as usize,
        }
    };
}

/// Every number of the configuration except these: the seed, which is unrestricted; waypoints and start,
/// which lie in free space; the six α, which are at least 0; the settings of matchers; guess noise and
/// extrapolation for frames without odometry, which a drive does not have; and what only serves recorded logs
/// and is off: the numbers for robots and the least score of a loop.
pub const RANGES: [ConfigRange; 56] = [
    number!(0.0, 100.0, drive.noise_factor),
    number!(0.2, 0.5, drive.dt_s),
    number!(0.1, 1.5, drive.driver.max_speed_mps),
    number!(0.2, 3.0, drive.driver.max_turn_rate_radps),
    number!(0.2, 6.0, drive.driver.heading_gain),
    number!(0.1, 1.5, drive.driver.turn_in_place_rad),
    number!(0.1, 2.0, drive.driver.slow_down_m),
    number!(0.1, 1.0, drive.driver.arrival_m),
    count!(1.0, 360.0, drive.lidar.beams),
    number!(0.1, TAU, drive.lidar.field_of_view_rad),
    number!(0.5, 20.0, drive.lidar.max_range_m),
    number!(0.0, 0.5, drive.lidar.range_sigma_m),
    number!(0.02, 1.0, drive.scan.cell_m),
    number!(0.05, 1.0, drive.scan.normal_radius_m),
    count!(1.0, 2000.0, drive.max_ticks),
    count!(1.0, 20.0, slam.window_scans),
    number!(0.0, 1.0, slam.window_distance_m),
    number!(0.0, 1.0, slam.window_turn_rad),
    number!(0.05, 1.0, slam.chapter.local_map.cell_m),
    count!(1.0, 20.0, slam.chapter.local_map.max_per_cell),
    count!(0.0, 50.0, slam.chapter.max_iterations),
    count!(0.0, 100.0, slam.min_inliers),
    number!(0.01, 3.0, slam.chapter.threshold.initial_m),
    number!(0.0, 0.5, slam.chapter.threshold.min_motion_m),
    number!(0.1, 20.0, slam.chapter.threshold.max_range_m),
    number!(0.05, 3.0, slam.keyframe_distance_m),
    number!(0.05, 3.0, slam.keyframe_turn_rad),
    number!(0.001, 1.0, slam.chapter.odometry_trust.sigma_m),
    number!(0.1, 1000.0, slam.chapter.odometry_trust.covariance_scale),
    number!(0.0, 1.0, slam.chapter.odometry_noise.floor_m),
    number!(0.0, 2.0, slam.chapter.odometry_noise.per_metre),
    number!(0.0, 1.0, slam.chapter.odometry_noise.metre_per_rad),
    number!(0.0, 1.0, slam.chapter.odometry_noise.floor_rad),
    number!(0.0, 2.0, slam.chapter.odometry_noise.per_rad),
    number!(0.0, 1.0, slam.chapter.odometry_noise.rad_per_metre),
    number!(0.1, 6.0, slam.chapter.loops.radius_m),
    count!(1.0, 100.0, slam.chapter.loops.min_gap_nodes),
    count!(1.0, 20.0, slam.chapter.loops.attempt_every_nodes),
    count!(1.0, 10.0, slam.chapter.loops.candidates_tried),
    count!(0.0, 10.0, slam.chapter.loops.submap_half_width),
    number!(0.05, 1.0, slam.chapter.loops.submap.cell_m),
    count!(1.0, 20.0, slam.chapter.loops.submap.max_per_cell),
    count!(0.0, 60.0, slam.chapter.loops.max_iterations),
    number!(0.01, 3.0, slam.chapter.loops.min_tau_m),
    number!(0.01, 2.0, slam.chapter.loops.max_rmse_m),
    count!(1.0, 200.0, slam.chapter.loops.min_inliers),
    number!(0.001, 1.0, slam.chapter.loops.trust.sigma_m),
    number!(0.1, 1000.0, slam.chapter.loops.trust.covariance_scale),
    number!(0.001, 1.0, slam.chapter.loops.drift_sigma_m),
    number!(0.0001, 1.0, slam.chapter.loops.drift_sigma_rad),
    number!(0.01, 1e6, slam.chapter.loops.gate_chi2),
    count!(0.0, 100.0, slam.optimizer_iterations),
    number!(0.0, 0.1, slam.optimizer_tolerance),
    number!(0.1, 1e6, slam.huber),
    START_X,
    START_Y,
];

/// The start of the chapter lies in the corridor, and so does every start nearby.
const START_X: ConfigRange = ConfigRange {
    field: "drive.start.x",
    low: 1.1,
    high: 1.6,
    get: |config| config.drive.start.x(),
    set: |config, x| {
        let start = config.drive.start;
        config.drive.start = SE2::new(x, start.y(), start.theta());
    },
};

const START_Y: ConfigRange = ConfigRange {
    field: "drive.start.y",
    low: 4.2,
    high: 4.65,
    get: |config| config.drive.start.y(),
    set: |config, y| {
        let start = config.drive.start;
        config.drive.start = SE2::new(start.x(), y, start.theta());
    },
};

/// A range is sampled by orders of magnitude if the quotient of its ends is at least this.
const WIDE: f64 = 50.0;

/// A lap of the chapter has 129 ticks; a driver that never arrives is stopped at this limit.
const MAX_RANDOM_TICKS: usize = 300;

impl ConfigRange {
    /// Draws a number from the range, sometimes exactly one of its ends.
    fn draw(&self, rng: &mut Rng) -> f64 {
        let share = rng.unit();
        let place = rng.unit();
        match share {
            ..0.05 => self.low,
            0.05..0.1 => self.high,
            _ if self.low > 0.0 && self.high > WIDE * self.low => {
                let orders = pr_geom::math::ln(self.high / self.low);
                (self.low * pr_geom::math::exp(place * orders)).clamp(self.low, self.high)
            }
            _ => self.low + place * (self.high - self.low),
        }
    }
}

/// A configuration with about half of its numbers drawn from their ranges, the rest at their
/// defaults, and at most 300 ticks; the same seed gives the same configuration.
#[must_use]
pub fn random_config(seed: u32) -> LapConfig {
    let mut rng = Rng::new(seed);
    let mut config = LapConfig::default();
    for range in &RANGES {
        let value = range.draw(&mut rng);
        if rng.unit() < 0.5 {
            (range.set)(&mut config, value);
        }
    }
    config.drive.seed = seed;
    config.drive.max_ticks = config.drive.max_ticks.min(MAX_RANDOM_TICKS);
    let start = config.drive.start;
    if rng.unit() < 0.5 {
        config.drive.start = SE2::new(start.x(), start.y(), rng.uniform(-PI, PI));
    }
    if rng.unit() < 0.1 {
        config.slam.loop_closure = LoopClosure::Off;
    }
    if rng.unit() < 0.3 {
        config.slam.chapter.loops.gate_model = GateModel::ExactMarginal;
    }
    if rng.unit() < 0.5 {
        config.slam.chapter.information_frame = InformationFrame::Exact;
    }
    config.slam.chapter.matcher = random_matcher(&mut rng);
    config.slam.chapter.loops.matcher = random_matcher(&mut rng);
    config
}

fn random_matcher(rng: &mut Rng) -> MatcherKind {
    match rng.unit() {
        ..0.5 => MatcherKind::PointToPoint,
        0.5..0.8 => MatcherKind::PointToPlane,
        _ => MatcherKind::Ndt(NdtMatcherConfig::default()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_default_lies_in_its_range_and_every_field_is_written_and_read() {
        for range in &RANGES {
            let mut config = LapConfig::default();
            let default = (range.get)(&config);
            let field = range.field;
            assert!((range.low..=range.high).contains(&default), "{field}");
            for value in [range.low, range.high] {
                (range.set)(&mut config, value);
                assert_eq!((range.get)(&config), value, "{field}");
            }
            (range.set)(&mut config, default);
            assert_eq!(
                config,
                LapConfig::default(),
                "{field} sets more than itself"
            );
        }
    }

    #[test]
    fn a_drawn_number_lies_in_its_range_and_reaches_both_ends() {
        let mut rng = Rng::new(1);
        for range in &RANGES {
            let drawn: Vec<f64> = (0..400).map(|_| range.draw(&mut rng)).collect();
            let inside = |value: &f64| (range.low..=range.high).contains(value);
            assert!(drawn.iter().all(inside), "{}", range.field);
            assert!(drawn.contains(&range.low) && drawn.contains(&range.high));
        }
    }
}
