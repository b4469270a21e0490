//! A hall whose scanner sweeps for a large part of the time between two scans.
//!
//! A scan deskewed by the velocity of the last one carries that velocity's error into its own: with g the sweep's
//! share of the period times the mean phase of the beams that see walls, the error obeys z² + g z − g = 0, which is
//! unstable for g > ½. Solved together with the pose, an error e becomes −e g / (1 + g).

use core::f64::consts::TAU;

use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::pipeline::LogFrame;
use ch16_slam2d::scan::LaserScan;
use pr_geom::{Rng, SE2, math};

/// Noise of a range, m.
const SIGMA_M: f64 = 0.01;
/// Duration of a recording, s.
const DURATION_S: f64 = 6.0;
/// Walls of the hall and of a pillar: x or y, at, from, to.
const WALLS: [(bool, f64, f64, f64); 8] = [
    (true, -4.0, -3.0, 3.0),
    (true, 4.0, -3.0, 3.0),
    (false, -3.0, -4.0, 4.0),
    (false, 3.0, -4.0, 4.0),
    (true, 2.6, -0.4, 0.5),
    (true, 3.2, -0.4, 0.5),
    (false, -0.4, 2.6, 3.2),
    (false, 0.5, 2.6, 3.2),
];

/// All of a sweep, its first half, and its last half.
pub const FULL: (f64, f64) = (0.0, 1.0);
/// See [`FULL`].
pub const EARLY: (f64, f64) = (0.0, 0.5);
/// See [`FULL`].
pub const LATE: (f64, f64) = (0.5, 1.0);

/// A scanner and its robot.
#[derive(Clone, Copy, Debug)]
pub struct SweepCase {
    /// Sweep over period.
    pub share: f64,
    /// Scans per second.
    pub rate_hz: f64,
    /// Number of beams.
    pub beams: usize,
    /// Part of the sweep that sees walls.
    pub view: (f64, f64),
    /// Largest turn on a circle of 1.5 m around the hall's centre, rad/s; 0: at rest.
    pub turn_rad_s: f64,
    /// Amplitude of a turn to and fro within 1.5 s, rad.
    pub weave_rad: f64,
    /// Largest error of a stamp over the period.
    pub jitter: f64,
}

impl Default for SweepCase {
    /// Ten full instantaneous scans a second of 360 beams, at rest.
    fn default() -> Self {
        Self {
            share: 0.0,
            rate_hz: 10.0,
            beams: 360,
            view: FULL,
            turn_rad_s: 0.0,
            weave_rad: 0.0,
            jitter: 0.0,
        }
    }
}

/// Largest position error, m, and lengths of the estimated and of the true path, m.
#[derive(Clone, Copy, Debug, Default)]
pub struct SweepErrors {
    /// Largest position error, m.
    pub worst_m: f64,
    /// Length of the estimated path, m.
    pub path_m: f64,
    /// Length of the true path, m.
    pub true_m: f64,
}

impl SweepErrors {
    /// Compares estimates with true poses.
    #[must_use]
    pub fn new(estimates: &[SE2], truth: &[SE2]) -> Self {
        let off_m = estimates.iter().zip(truth);
        let off_m = off_m.map(|(estimate, right)| position_error_m(estimate, right));
        let length_m = |path: &[SE2]| {
            let steps = path.windows(2);
            steps.map(|two| position_error_m(&two[0], &two[1])).sum()
        };
        Self {
            worst_m: off_m.fold(0.0, math::max),
            path_m: length_m(estimates),
            true_m: length_m(truth),
        }
    }
}

impl SweepCase {
    /// Pose of the robot, which speeds up for two seconds.
    #[must_use]
    pub fn truth(&self, at_s: f64) -> SE2 {
        let angle = if at_s < 2.0 {
            at_s * at_s / 4.0
        } else {
            at_s - 1.0
        };
        let around = self.turn_rad_s * angle;
        let (sin, cos) = math::sin_cos(around);
        let weave = self.weave_rad * math::sin_cos(at_s * TAU / 1.5).0;
        SE2::new(1.5 * cos, 1.5 * sin, around + TAU / 4.0 + weave)
    }

    /// The frames of a recording, with the true pose as odometry, and the true poses.
    #[must_use]
    pub fn recording(&self) -> (Vec<LogFrame>, Vec<SE2>) {
        let mut rng = Rng::new(7);
        let scans = (0..(DURATION_S * self.rate_hz) as usize).map(|number| {
            let begins_s = number as f64 / self.rate_hz;
            let late = self.jitter * rng.uniform(-1.0, 1.0);
            let truth = self.truth(begins_s);
            let frame = LogFrame {
                stamp_s: begins_s + late / self.rate_hz,
                odometry: Some(truth),
                scan: self.scan(begins_s, &mut rng),
            };
            (frame, truth)
        });
        scans.unzip()
    }

    fn scan(&self, begins_s: f64, rng: &mut Rng) -> LaserScan {
        let sweep_s = self.share / self.rate_hz;
        let mut scan = LaserScan {
            angle_step_rad: TAU / self.beams as f64,
            range_max_m: 12.0,
            beam_interval_s: sweep_s / (self.beams - 1) as f64,
            ..LaserScan::default()
        };
        let ranges = (0..self.beams).map(|beam| {
            let phase = beam as f64 / (self.beams - 1) as f64;
            if phase < self.view.0 || phase > self.view.1 {
                return 0.0;
            }
            let pose = self.truth(begins_s + phase * sweep_s);
            let (sin, cos) = math::sin_cos(pose.theta() + scan.bearing_rad(beam));
            let to_wall = WALLS.iter().filter_map(|&(is_x, at, from, to)| {
                let (range, along) = if is_x {
                    let range = (at - pose.x()) / cos;
                    (range, pose.y() + range * sin)
                } else {
                    let range = (at - pose.y()) / sin;
                    (range, pose.x() + range * cos)
                };
                (range > 0.0 && (from..=to).contains(&along)).then_some(range)
            });
            to_wall.fold(f64::INFINITY, math::min) + rng.normal(0.0, SIGMA_M)
        });
        scan.ranges_m = ranges.collect();
        scan
    }
}
