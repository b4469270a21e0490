//! Sweeps that take a large part of the time between two scans, without odometry.
//!
//! A scan deskewed by the velocity of the last one carries that velocity's error into its own: with g the sweep's
//! share of the period times the mean phase of the beams that see walls, the error obeys z² + g z − g = 0, which is
//! unstable for g > ½. Solved together with the pose, an error e becomes −e g / (1 + g).

use core::f64::consts::TAU;

use ch16_slam2d::metrics::position_error_m;
use ch16_slam2d::scan::{Frame, LaserScan};
use ch16_slam2d::slam::{LoopClosure, Slam, SlamConfig};
use pr_geom::{Rng, SE2, math};

/// Noise of a range, m.
const SIGMA_M: f64 = 0.01;
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

/// A recording.
#[derive(Clone, Copy, Debug)]
struct Case {
    /// Sweep over period.
    share: f64,
    rate_hz: f64,
    beams: usize,
    /// Part of the sweep that sees walls.
    view: (f64, f64),
    /// Largest turn, rad/s; the robot drives on a circle of 1.5 m around the hall's centre. 0: at rest.
    turn_rad_s: f64,
    /// Largest error of a stamp over the period.
    jitter: f64,
}

/// Largest position error, m, and lengths of the estimated and of the true path, m.
#[derive(Clone, Copy, Debug, Default)]
struct Run {
    worst_m: f64,
    path_m: f64,
    true_m: f64,
}

impl Case {
    /// Speeds up for two seconds.
    fn truth(&self, at_s: f64) -> SE2 {
        let angle = if at_s < 2.0 {
            at_s * at_s / 4.0
        } else {
            at_s - 1.0
        };
        let heading = self.turn_rad_s * angle;
        let (sin, cos) = math::sin_cos(heading);
        SE2::new(1.5 * cos, 1.5 * sin, heading + TAU / 4.0)
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
            to_wall.fold(f64::INFINITY, f64::min) + rng.normal(0.0, SIGMA_M)
        });
        scan.ranges_m = ranges.collect();
        scan
    }

    /// Maps the recording; `is_joint` if the velocity is found together with the pose.
    fn run(&self, estimator: fn(&LaserScan) -> SlamConfig, is_joint: bool) -> Run {
        let mut rng = Rng::new(7);
        let mut slam: Option<Slam> = None;
        let mut run = Run::default();
        let mut last = (self.truth(0.0), self.truth(0.0));
        let start = self.truth(0.0);
        for number in 0..(6.0 * self.rate_hz) as usize {
            let begins_s = number as f64 / self.rate_hz;
            let late = self.jitter * rng.uniform(-1.0, 1.0);
            let frame = Frame {
                stamp_s: begins_s + late / self.rate_hz,
                odometry: None,
                scan: self.scan(begins_s, &mut rng),
            };
            let slam = slam.get_or_insert_with(|| {
                let mut slam = Slam::new(SlamConfig {
                    start,
                    ..estimator(&frame.scan)
                });
                slam.set_loop_closure(LoopClosure::Off);
                slam
            });
            let mut prepared = slam.prepare(&frame).unwrap();
            if !is_joint {
                prepared.sweep = None;
            }
            let report = slam.step_prepared(&prepared).unwrap();
            let truth = self.truth(begins_s);
            let off_m = position_error_m(&report.estimate, &truth);
            run.worst_m = math::max(run.worst_m, off_m);
            run.path_m += position_error_m(&report.estimate, &last.0);
            run.true_m += position_error_m(&truth, &last.1);
            last = (report.estimate, truth);
        }
        run
    }
}

const FULL: (f64, f64) = (0.0, 1.0);
const EARLY: (f64, f64) = (0.0, 0.5);
const LATE: (f64, f64) = (0.5, 1.0);

/// Slow and fast sensors of few and many beams, whose walls are seen early or late, and one with poor stamps.
const SENSORS: [(f64, usize, (f64, f64), f64); 7] = [
    (2.0, 360, FULL, 0.0),
    (5.0, 1440, FULL, 0.0),
    (10.0, 360, FULL, 0.0),
    (12.0, 90, FULL, 0.0),
    (10.0, 360, EARLY, 0.0),
    (10.0, 360, LATE, 0.0),
    (5.0, 360, FULL, 0.45),
];

fn cases(turn_rad_s: f64) -> impl Iterator<Item = Case> {
    let of_share = move |share| {
        SENSORS.map(|(rate_hz, beams, view, jitter)| Case {
            share,
            rate_hz,
            beams,
            view,
            turn_rad_s,
            jitter,
        })
    };
    [0.0, 0.5, 1.0, 1.25].into_iter().flat_map(of_share)
}

#[test]
fn the_pose_is_stable_however_much_of_the_period_a_sweep_takes() {
    for case in cases(0.0).chain(cases(0.6)) {
        let run = case.run(SlamConfig::for_robot, true);
        // 5 cm: twice the motion that an acceleration of 0.45 m/s² hides in half a second. 20 cm: the sum of 72 steps of
        // 3 mm, which is the noise of instantaneous scans.
        assert!(run.worst_m < 0.05, "{case:?}: {run:?}");
        assert!(run.path_m - run.true_m < 0.2, "{case:?}: {run:?}");
    }
}

#[test]
fn the_velocity_of_the_last_scan_alone_makes_a_robot_at_rest_move() {
    let case = Case {
        share: 1.0,
        rate_hz: 10.0,
        beams: 360,
        view: LATE,
        turn_rad_s: 0.0,
        jitter: 0.0,
    };
    let run = case.run(SlamConfig::for_robot, false);
    assert!(run.path_m > 2.0, "{run:?}");
}

#[test]
fn the_chapter_s_matcher_is_as_accurate_with_sweeps_that_fill_the_period() {
    for (view, turn_rad_s) in [(FULL, 0.0), (LATE, 0.0), (FULL, 0.6), (EARLY, 0.6)] {
        let run = |share| {
            let case = Case {
                share,
                rate_hz: 10.0,
                beams: 360,
                view,
                turn_rad_s,
                jitter: 0.0,
            };
            case.run(|_| SlamConfig::default(), true)
        };
        let (instant, full) = (run(0.0), run(1.0));
        assert!(
            full.worst_m < instant.worst_m + 0.01,
            "{instant:?} {full:?}"
        );
        assert!(full.path_m < instant.path_m + 0.05, "{instant:?} {full:?}");
    }
}
