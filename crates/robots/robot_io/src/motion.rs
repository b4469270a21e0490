//! Compares scans with odometry to check the mounting of the laser and the units and clock of the odometry.
//!
//! The first scans are matched without odometry. Over each segment of the path this gives the motion of the sensor,
//! and odometry gives the motion of the body:
//!
//! | quantity | expected | otherwise |
//! |---|---|---|
//! | correlation of the turns | near 1 | near −1: the scans are mirrored |
//! | angle between the displacements | 0 | 180°: the laser faces backward |
//! | ratio of the displacements | 1 | 1000: millimetres; off by a tenth: wheel size |
//! | ratio of the turns | 1 | off by a tenth: distance between the wheels |
//! | lag that maximizes the correlation of the turns | 0 | clock offset of less than a second |
//!
//! If the beams of a scan have times, the opposite order of the beams is tried as well.
//!
//! This comparison only proposes: scans that cannot be matched alone agree with nothing, and a fault that is not there may
//! seem to be. A finding needs the agreement of most segments, and then a trial: the part of the log that was compared is
//! mapped with and without its repair ([`trial`]).

mod compared;
mod finding;
mod lag;
mod reader;
mod remarks;
mod repairs;
mod trial;
mod turns;

pub use crate::odometry_use::OdometryUse;
pub use compared::MotionComparison;
pub(crate) use compared::unit_of;
pub use finding::{Costs, Finding, Suggestion};
pub use reader::ComparedReader;

use ch16_slam2d::scan::{Frame, LaserScan};
use ch16_slam2d::slam::{Slam, SlamConfig};
use pr_geom::SE2;

use crate::log::LogFrame;
use lag::Heading;

/// A segment ends after this motion of the sensor, m or rad.
const STRETCH_M: f64 = 0.3;
const STRETCH_RAD: f64 = 0.25;
/// A scan counts in a trial after this motion of the sensor since the last one that does, m or rad: at rest, odometry
/// that always stands still is right.
const STEP_M: f64 = 0.05;
const STEP_RAD: f64 = 0.05;
/// Scans closer in time add no information, s.
const MIN_APART_S: f64 = 0.08;

/// A segment of the path, by scans and by odometry.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    /// Motion of the sensor in its own frame.
    sensor: SE2,
    /// Motion of the body.
    body: SE2,
    /// Heading of the body at its start, rad.
    heading_rad: f64,
}

impl Stretch {
    /// The segment by odometry with the opposite sign of its headings or of its y.
    fn opposed(&self, is_heading: bool) -> Self {
        // R(-θ)ᵀ = R(2θ) R(θ)ᵀ: the heading at the start has turned the motion the wrong way.
        let turn = SE2::new(0.0, 0.0, 2.0 * self.heading_rad);
        let [x, y, _] = (turn * self.body).to_array();
        let theta = self.body.theta();
        let (body, heading_rad) = if is_heading {
            (SE2::new(x, y, -theta), -self.heading_rad)
        } else {
            (SE2::new(x, -y, theta), self.heading_rad)
        };
        Self {
            body,
            heading_rad,
            ..*self
        }
    }
}

/// Scans matched without odometry, and the odometry at their stamps.
struct Comparison {
    slam: Slam,
    last_s: f64,
    /// Start of the last segment: the sensor by scans, and the body by odometry.
    began: Option<(SE2, SE2)>,
    stretches: Vec<Stretch>,
    headings: Vec<Heading>,
    /// Stamps (s) of scans after a motion, and the pose of the last one.
    steps_s: Vec<f64>,
    last_step: Option<SE2>,
    moved_m: f64,
    turned_rad: f64,
    last_estimate: Option<(f64, SE2)>,
    /// Largest turn during a sweep, in steps between two beams.
    skew: f64,
    /// Stamp of the last scan, s, and for each scan the time of its sweep and that since the one before, s.
    stamp_s: Option<f64>,
    sweeps: Vec<(f64, f64)>,
}

impl Comparison {
    fn new(first: &LogFrame) -> Self {
        Self {
            slam: Slam::new(SlamConfig::for_robot(&unmounted(&first.scan))),
            last_s: f64::NEG_INFINITY,
            began: None,
            stretches: Vec::new(),
            headings: Vec::new(),
            steps_s: Vec::new(),
            last_step: None,
            moved_m: 0.0,
            turned_rad: 0.0,
            last_estimate: None,
            skew: 0.0,
            stamp_s: None,
            sweeps: Vec::new(),
        }
    }

    fn add(&mut self, log: &LogFrame) {
        if let Some(before_s) = self.stamp_s.replace(log.stamp_s) {
            let sweep = (log.scan.sweep_s(), log.stamp_s - before_s);
            self.sweeps.push(sweep);
        }
        if log.stamp_s - self.last_s < MIN_APART_S {
            return;
        }
        let frame = Frame {
            stamp_s: log.stamp_s,
            odometry: None,
            scan: unmounted(&log.scan),
        };
        let Ok(report) = self.slam.step(&frame) else {
            return;
        };
        self.last_s = log.stamp_s;
        let last = self.last_estimate.replace((log.stamp_s, report.estimate));
        if let Some((last_s, last)) = last {
            let turn_rad = last.between(&report.estimate).theta().abs();
            let in_sweep_rad = turn_rad * log.scan.sweep_s() / (log.stamp_s - last_s);
            self.skew = self.skew.max(in_sweep_rad / log.scan.angle_step_rad.abs());
        }
        let has_moved = self.last_step.is_none_or(|last| {
            let [x, y, turn] = last.between(&report.estimate).to_array();
            pr_geom::math::norm2(x, y) >= STEP_M || turn.abs() >= STEP_RAD
        });
        if has_moved {
            self.last_step = Some(report.estimate);
            self.steps_s.push(log.stamp_s);
        }
        let Some(body) = log.odometry else {
            self.began = None;
            return;
        };
        self.headings.push(Heading {
            stamp_s: log.stamp_s,
            by_scans: report.estimate.theta(),
            by_odometry: body.theta(),
        });
        let now = (report.estimate, body);
        let Some(began) = self.began else {
            self.began = Some(now);
            return;
        };
        let sensor = began.0.between(&now.0);
        let [x, y, turn] = sensor.to_array();
        let moved_m = pr_geom::math::norm2(x, y);
        if moved_m >= STRETCH_M || turn.abs() >= STRETCH_RAD {
            self.moved_m += moved_m;
            self.turned_rad += turn.abs();
            self.stretches.push(Stretch {
                sensor,
                body: began.1.between(&now.1),
                heading_rad: began.1.theta(),
            });
            self.began = Some(now);
        }
    }

    /// Whether further scans add no information.
    fn is_enough(&self) -> bool {
        self.stretches.len() >= 60 && self.moved_m >= 10.0 && self.turned_rad >= 6.0
    }
}

/// A scan with the sensor at the body's origin.
fn unmounted(scan: &LaserScan) -> LaserScan {
    LaserScan {
        body_from_sensor: SE2::identity(),
        ..scan.clone()
    }
}
