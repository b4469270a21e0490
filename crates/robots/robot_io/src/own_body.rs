//! The robot's own body in the view of its laser: a post or a tower that the same beams see at the same range wherever
//! the robot is.
//!
//! Two explanations of every near reading are tried on pairs of places that odometry tells apart: the beam sees the body,
//! so it has the same range at the second place; or it sees the world, so another beam there meets the same point. A beam
//! is cut out only where the first holds and the second fails. Beside a wall that the robot drives along both hold, and
//! nothing is cut.
//!
//! Without odometry, the beams that always see the same range are left out of the scans, and these are matched alone: that
//! gives the places, and the same trial decides.

use std::collections::VecDeque;

use ch16_slam2d::scan::{Frame, LaserScan};
use ch16_slam2d::slam::{LoopClosure, Slam, SlamConfig};
use pr_geom::{Point2, SE2, math};

use crate::log::{LogError, LogFrame, LogNotes, LogReader};
use crate::remark::{Part, Remark};
use crate::stamps::median;

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
const MAX_ALONE: usize = 600;
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
    fn add(&mut self, body: Option<SE2>, scan: &LaserScan) -> bool {
        let Some(odometry) = body else {
            return true;
        };
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
            let is_same_sensor = trial.add(frame.odometry, &frame.scan);
            let has_odometry = frame.odometry.is_some();
            let is_first = self.waiting.is_empty();
            self.waiting.push_back(frame);
            if !is_same_sensor {
                return Ok(Vec::new());
            }
            if !has_odometry && is_first {
                return self.find_alone();
            }
            if !has_odometry {
                break;
            }
        }
        Ok(self.decided(&trial))
    }

    /// The same without odometry, after the first scan was read.
    fn find_alone(&mut self) -> Result<Vec<f64>, LogError> {
        let mut beams = 0;
        while self.waiting.len() < MAX_ALONE && beams < MAX_BEAMS {
            // An error recurs once these frames are consumed.
            let Ok(Some(frame)) = self.inner.next_frame() else {
                break;
            };
            beams += frame.scan.ranges_m.len().max(1);
            self.waiting.push_back(frame);
        }
        let steady = steady(&self.waiting);
        let mut trial = Trial::default();
        if !steady.contains(&true) {
            return Ok(Vec::new());
        }
        let mut slam: Option<Slam> = None;
        for LogFrame { stamp_s, scan, .. } in &self.waiting {
            let mut without = scan.clone();
            let ranges = without.ranges_m.iter_mut().zip(&steady);
            for (range_m, _) in ranges.filter(|(_, steady)| **steady) {
                *range_m = f64::NAN;
            }
            let slam = slam.get_or_insert_with(|| {
                let mut slam = Slam::new(SlamConfig::for_robot(&without));
                slam.set_loop_closure(LoopClosure::Off);
                slam
            });
            let frame = Frame {
                stamp_s: *stamp_s,
                odometry: None,
                scan: without,
            };
            let body = slam.step(&frame).ok().map(|report| report.estimate);
            if trial.pairs >= ENOUGH_PAIRS || !trial.add(body, scan) {
                break;
            }
        }
        Ok(self.decided(&trial))
    }

    fn decided(&mut self, trial: &Trial) -> Vec<f64> {
        let limits_m = trial.limits_m();
        if let (Some((_, scan)), false) = (&trial.last, limits_m.is_empty()) {
            self.remark = Some(remark(scan, &limits_m));
        }
        limits_m
    }
}

/// Beams that see the same near range in nearly all scans; empty if the beams change.
fn steady(frames: &VecDeque<LogFrame>) -> Vec<bool> {
    let count = frames.front().map_or(0, |first| first.scan.ranges_m.len());
    let is_changed = |frame: &LogFrame| frame.scan.ranges_m.len() != count;
    if frames.iter().any(is_changed) {
        return Vec::new();
    }
    let is_steady = |beam: usize| {
        let scans = || frames.iter().map(|frame| &frame.scan);
        let seen = scans().filter(|scan| scan.is_return(scan.ranges_m[beam]));
        let usual_m = median(seen.map(|scan| scan.ranges_m[beam]).collect());
        usual_m.is_some_and(|usual_m| {
            let same = scans().filter(|scan| (scan.ranges_m[beam] - usual_m).abs() < BODY_M);
            usual_m < FARTHEST_M && same.count() as f64 >= SEES_BODY * frames.len() as f64
        })
    };
    (0..count).map(is_steady).collect()
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
mod tests;
