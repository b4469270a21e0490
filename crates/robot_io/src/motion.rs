//! Scans and odometry compared: does the laser sit as the recording says, and what does odometry measure in?
//!
//! The first scans are matched alone. Over each stretch of the path that gives the motion of the sensor, and
//! odometry gives that of the body:
//!
//! | what | right | else |
//! |---|---|---|
//! | correlation of the turns | near 1 | near −1: the scans are a mirror image |
//! | angle between the displacements | 0 | 180°: the laser looks backward |
//! | ratio of the displacements | 1 | 1000: millimetres; a tenth off: wheel size |
//! | lag at which the turns correlate best | 0 | clocks that differ by less than a second |
//!
//! A finding needs most stretches to agree on it, so that scans which cannot be matched alone find nothing.

mod finding;
mod lag;
mod reader;

pub use finding::{Finding, Motion};
pub use reader::ComparedReader;

use ch16_slam2d::scan::{Frame, LaserScan};
use ch16_slam2d::slam::{Slam, SlamConfig};
use pr_geom::SE2;

use crate::log::LogFrame;
use lag::Heading;

/// A stretch ends after so much motion of the sensor, m or rad.
const STRETCH_M: f64 = 0.3;
const STRETCH_RAD: f64 = 0.25;
/// Scans nearer in time say nothing new, s.
const LEAST_APART_S: f64 = 0.08;

/// A stretch of the path, by scans and by odometry.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    /// Motion of the sensor in its own frame.
    sensor: SE2,
    /// Motion of the body.
    body: SE2,
}

/// Scans matched alone, and the odometry beside them.
struct Comparison {
    slam: Slam,
    last_s: f64,
    /// Where the last stretch began: the sensor by scans, and the body by odometry.
    began: Option<(SE2, SE2)>,
    stretches: Vec<Stretch>,
    headings: Vec<Heading>,
    moved_m: f64,
    turned_rad: f64,
}

impl Comparison {
    fn new(first: &LogFrame) -> Self {
        Self {
            slam: Slam::new(SlamConfig::for_robot(&unmounted(&first.scan))),
            last_s: f64::NEG_INFINITY,
            began: None,
            stretches: Vec::new(),
            headings: Vec::new(),
            moved_m: 0.0,
            turned_rad: 0.0,
        }
    }

    fn take(&mut self, log: &LogFrame) {
        if log.stamp_s - self.last_s < LEAST_APART_S {
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
            });
            self.began = Some(now);
        }
    }

    /// Whether more would add nothing.
    fn is_enough(&self) -> bool {
        self.stretches.len() >= 60 && self.moved_m >= 10.0 && self.turned_rad >= 6.0
    }
}

/// A scan as if its laser were the body.
fn unmounted(scan: &LaserScan) -> LaserScan {
    LaserScan {
        body_from_sensor: SE2::identity(),
        ..scan.clone()
    }
}
