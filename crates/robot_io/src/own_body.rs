//! The robot's own body in the view of its laser: a post or a tower that the same beams see at the same range wherever
//! the robot is.
//!
//! Two explanations of every near reading are tried on pairs of places that odometry tells apart: the beam sees the body,
//! so it has the same range at the second place; or it sees the world, so another beam there meets the same point. A beam
//! is cut out only where the first holds and the second fails. Beside a wall that the robot drives along both hold, and
//! nothing is cut.

use std::collections::VecDeque;

use ch16_slam2d::scan::LaserScan;
use pr_geom::{Point2, SE2, math};

use crate::log::{LogError, LogFrame, LogNotes, LogReader};
use crate::remark::{Part, Remark};

/// Farther readings are not the robot's, m.
const FARTHEST_M: f64 = 1.5;
/// Places differ by this, m or rad.
const APART: f64 = 0.3;
/// Pairs of places for a decision, and the number after which no more are looked for.
const FEWEST_PAIRS: usize = 10;
const ENOUGH_PAIRS: usize = 60;
/// The body stays where it is within this, m.
const BODY_M: f64 = 0.04;
/// A point of the world is met again within this, m, and this share of its distance: odometry drifts.
const WORLD_M: f64 = 0.08;
const WORLD_SHARE: f64 = 0.05;
/// Share of pairs in which a beam must see the body, and in which the world must fail to explain that.
const SEES_BODY: f64 = 0.9;
const NO_WORLD: f64 = 0.5;
/// Share of all readings that the world must explain: else odometry tells nothing.
const EXPLAINED: f64 = 0.3;
/// Most scans and beams that are kept for the decision.
const MAX_SCANS: usize = 2000;
const MAX_BEAMS: usize = 1 << 21;

/// How often each beam was explained.
#[derive(Debug, Default)]
struct Trial {
    /// The scan at the last place.
    last: Option<(SE2, LaserScan)>,
    pairs: usize,
    /// For each beam: pairs in which it saw the body, those in which the world failed to explain it, and the sum of ranges.
    beams: Vec<(usize, usize, f64)>,
    readings: usize,
    explained: usize,
}

impl Trial {
    /// Compares a scan with that of the last place; false if the beams have changed.
    fn add(&mut self, frame: &LogFrame) -> bool {
        let Some(odometry) = frame.odometry else {
            return true;
        };
        let scan = &frame.scan;
        let Some((before, old)) = &self.last else {
            self.beams = vec![(0, 0, 0.0); scan.ranges_m.len()];
            self.last = Some((odometry, scan.clone()));
            return true;
        };
        if old.ranges_m.len() != scan.ranges_m.len()
            || old.first_angle_rad != scan.first_angle_rad
            || old.angle_step_rad != scan.angle_step_rad
        {
            return false;
        }
        let moved = before.between(&odometry);
        if math::norm2(moved.x(), moved.y()) < APART && moved.theta().abs() < APART {
            return true;
        }
        let mount = scan.body_from_sensor;
        let then_from_now = (mount.inverse() * moved.inverse()) * mount;
        for (beam, &range_m) in old.ranges_m.iter().enumerate() {
            if !old.is_return(range_m) {
                continue;
            }
            let (sin, cos) = math::sin_cos(old.bearing_rad(beam));
            let point = then_from_now.transform(Point2::new(range_m * cos, range_m * sin));
            let is_met = is_met(scan, point);
            self.readings += 1;
            self.explained += usize::from(is_met == Some(true));
            let now_m = scan.ranges_m[beam];
            if range_m < FARTHEST_M && scan.is_return(now_m) && (now_m - range_m).abs() < BODY_M {
                let (body, no_world, sum_m) = &mut self.beams[beam];
                *body += 1;
                *no_world += usize::from(is_met == Some(false));
                *sum_m += range_m;
            }
        }
        self.pairs += 1;
        self.last = Some((odometry, scan.clone()));
        true
    }

    /// Range up to which readings of each beam are cut out, m; empty if no beam sees the body.
    fn limits_m(&self) -> Vec<f64> {
        let pairs = self.pairs as f64;
        let is_told = self.explained as f64 >= EXPLAINED * self.readings as f64;
        if self.pairs < FEWEST_PAIRS || !is_told {
            return Vec::new();
        }
        let limit = |&(body, no_world, sum_m): &(usize, usize, f64)| {
            let is_body = body as f64 >= SEES_BODY * pairs && no_world as f64 >= NO_WORLD * pairs;
            if is_body {
                sum_m / body as f64 + BODY_M
            } else {
                0.0
            }
        };
        let limits_m: Vec<f64> = self.beams.iter().map(limit).collect();
        if limits_m.iter().all(|limit_m| *limit_m == 0.0) {
            return Vec::new();
        }
        limits_m
    }
}

/// Whether a scan meets this point in the sensor's frame; `None` if no beam looks there.
fn is_met(scan: &LaserScan, point: Point2<f64>) -> Option<bool> {
    let range_m = math::norm2(point.x, point.y);
    let turn = math::atan2(point.y, point.x) - scan.first_angle_rad;
    let turn = turn * scan.angle_step_rad.signum();
    let beam =
        (turn.rem_euclid(core::f64::consts::TAU) / scan.angle_step_rad.abs()).round() as usize;
    let near = beam.saturating_sub(1)..=beam + 1;
    let mut readings = near.filter_map(|beam| scan.ranges_m.get(beam)).peekable();
    readings.peek()?;
    let tolerance_m = WORLD_M + WORLD_SHARE * range_m;
    Some(readings.any(|reading_m| (reading_m - range_m).abs() < tolerance_m))
}

/// Removes readings of the robot's own body.
pub struct BodyReader<'a> {
    inner: Box<dyn LogReader + 'a>,
    waiting: VecDeque<LogFrame>,
    limits_m: Option<Vec<f64>>,
    remark: Option<Remark>,
    notes: LogNotes,
}

impl<'a> BodyReader<'a> {
    /// Wraps a reader.
    #[must_use]
    pub fn new(inner: Box<dyn LogReader + 'a>) -> Self {
        Self {
            inner,
            waiting: VecDeque::new(),
            limits_m: None,
            remark: None,
            notes: LogNotes::default(),
        }
    }

    /// Reads the first scans and finds the body.
    fn find(&mut self) -> Result<Vec<f64>, LogError> {
        let mut trial = Trial::default();
        let mut beams = 0;
        while self.waiting.len() < MAX_SCANS && beams < MAX_BEAMS && trial.pairs < ENOUGH_PAIRS {
            let frame = match self.inner.next_frame() {
                Ok(Some(frame)) => frame,
                Ok(None) => break,
                Err(error) if self.waiting.is_empty() => return Err(error),
                // The error recurs once these frames are consumed.
                Err(_) => break,
            };
            beams += frame.scan.ranges_m.len().max(1);
            let is_same_sensor = trial.add(&frame);
            let has_odometry = frame.odometry.is_some();
            self.waiting.push_back(frame);
            if !is_same_sensor {
                return Ok(Vec::new());
            }
            if !has_odometry {
                break;
            }
        }
        let limits_m = trial.limits_m();
        if let (Some((_, scan)), false) = (&trial.last, limits_m.is_empty()) {
            self.remark = Some(remark(scan, &limits_m));
        }
        Ok(limits_m)
    }
}

/// What was cut out.
fn remark(scan: &LaserScan, limits_m: &[f64]) -> Remark {
    let cut = || (0..limits_m.len()).filter(|&beam| limits_m[beam] > 0.0);
    let width = cut().count() as f64 * scan.angle_step_rad.abs().to_degrees();
    let near_m = cut()
        .map(|beam| limits_m[beam] - BODY_M)
        .fold(f64::INFINITY, f64::min);
    let (sin, cos) = cut().fold((0.0, 0.0), |(sin, cos), beam| {
        let (s, c) = math::sin_cos(scan.bearing_rad(beam));
        (sin + s, cos + c)
    });
    let middle = math::atan2(sin, cos).to_degrees();
    Remark::mended(
        Part::Sensor,
        format!(
            "{} beams, {width:.0}° around {middle:.0}°, see the robot's own body from {near_m:.2} m on, the same wherever it drives; they were cut out. --min-range or --footprint does it by hand",
            cut().count()
        ),
    )
}

impl LogReader for BodyReader<'_> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        if self.limits_m.is_none() {
            let found = self.find();
            self.notes.clone_from(self.inner.notes());
            self.limits_m = Some(found?);
        }
        let frame = match self.waiting.pop_front() {
            Some(frame) => Ok(Some(frame)),
            None => self.inner.next_frame(),
        };
        self.notes.clone_from(self.inner.notes());
        self.notes.warnings.extend(self.remark.clone());
        let mut frame = frame?;
        if let (Some(frame), Some(limits_m)) = (&mut frame, &self.limits_m) {
            for (range_m, limit_m) in frame.scan.ranges_m.iter_mut().zip(limits_m) {
                if *range_m <= *limit_m {
                    *range_m = f64::NAN;
                }
            }
        }
        Ok(frame)
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{PI, TAU};

    use super::*;

    /// Readings in a room of 10 m × 6 m, with a post of 0.3 m over the last third of the beams if there is one.
    struct Room {
        frames: VecDeque<LogFrame>,
        notes: LogNotes,
    }

    impl Room {
        fn new(poses: impl Iterator<Item = SE2>, has_post: bool) -> Box<Self> {
            let beams = 120;
            let step = TAU / f64::from(beams);
            let frame = |(number, pose): (usize, SE2)| {
                let range_m = |beam: i32| {
                    if has_post && beam >= 80 {
                        return 0.3;
                    }
                    let (sin, cos) = math::sin_cos(pose.theta() - PI + f64::from(beam) * step);
                    let along = if cos > 0.0 {
                        10.0 - pose.x()
                    } else {
                        -pose.x()
                    };
                    let across = if sin > 0.0 { 6.0 - pose.y() } else { -pose.y() };
                    (along / cos).min(across / sin)
                };
                LogFrame {
                    stamp_s: number as f64,
                    odometry: Some(pose),
                    scan: LaserScan {
                        first_angle_rad: -PI,
                        angle_step_rad: step,
                        ranges_m: (0..beams).map(range_m).collect(),
                        ..LaserScan::default()
                    },
                }
            };
            Box::new(Self {
                frames: poses.enumerate().map(frame).collect(),
                notes: LogNotes::default(),
            })
        }
    }

    impl LogReader for Room {
        fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
            Ok(self.frames.pop_front())
        }

        fn notes(&self) -> &LogNotes {
            &self.notes
        }
    }

    /// Number of readings cut out of the last scan, and the number of remarks.
    fn cut(room: Box<Room>) -> (usize, usize) {
        let mut reader = BodyReader::new(room);
        let mut last = 0;
        while let Some(frame) = reader.next_frame().unwrap() {
            last = frame
                .scan
                .ranges_m
                .iter()
                .filter(|range_m| range_m.is_nan())
                .count();
        }
        (last, reader.notes().warnings.len())
    }

    fn along_a_wall() -> impl Iterator<Item = SE2> {
        // 0.3 m beside a wall: its beams see the same range everywhere.
        (0..40).map(|k| SE2::new(1.0 + 0.2 * f64::from(k), 0.3, 0.0))
    }

    fn around() -> impl Iterator<Item = SE2> {
        (0..40).map(|k| {
            let turn = 0.15 * f64::from(k);
            SE2::new(5.0 + 2.0 * math::cos(turn), 3.0 + math::sin(turn), turn)
        })
    }

    #[test]
    fn a_body_in_view_is_cut_out_and_said() {
        assert_eq!(cut(Room::new(around(), true)), (40, 1));
    }

    #[test]
    fn a_wall_beside_the_way_and_a_robot_at_rest_lose_nothing() {
        assert_eq!(cut(Room::new(around(), false)), (0, 0));
        assert_eq!(cut(Room::new(along_a_wall(), false)), (0, 0));
        let at_rest = || (0..300).map(|_| SE2::new(0.4, 0.4, 0.0));
        assert_eq!(cut(Room::new(at_rest(), false)), (0, 0));
    }
}
