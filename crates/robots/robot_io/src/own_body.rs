//! What travels with the robot in the view of its laser: a post or a tower of its own, which the same beams see at the same
//! range wherever the robot is; and the floor before a laser that leans, a straight line that is fixed in its frame.
//!
//! Two explanations of every reading are tried on pairs of places that odometry tells apart: the beam sees what travels,
//! so it has the same range at the second place; or it sees the world, so another beam there meets the same point. A beam
//! is cut out only where the first holds and the second fails. Beside a wall that the robot drives along both hold, and
//! nothing is cut. Something nearer may hide the floor, and nothing is seen beyond it, also while the robot turns.
//!
//! Without odometry, the beams that always see the same range, and the line beyond which nothing is ever seen, are left out
//! of the scans, and these are matched alone: that gives the places, and the same trial decides.

mod line;
mod trial;

use std::collections::VecDeque;
use std::mem;

use ch16_slam2d::scan::{Frame, LaserScan};
use ch16_slam2d::slam::{LoopClosure, Slam, SlamConfig};
use pr_geom::{math, sort_numbers};

use self::line::Line;
use self::trial::Trial;
use crate::log::{LogError, LogFrame, LogNotes, LogReader};
use crate::remark::{Part, Remark};

/// Farther readings are not the robot's, m.
const FARTHEST_M: f64 = 1.5;
/// What travels with the robot stays where it is within this, m, and this share of its distance: the error of ranges.
const BODY_M: f64 = 0.04;
const BODY_SHARE: f64 = 0.01;
/// Share of readings that must agree that something travels with the robot.
const FIXED: f64 = 0.9;
/// Share of a beam's readings that may be farther than the floor, before the floor is looked for without odometry.
const FARTHER: f64 = 0.05;
/// Most scans and beams that are kept for the decision.
const MAX_SCANS: usize = 2000;
const MAX_ALONE: usize = 600;
const MAX_BEAMS: usize = 1 << 21;

/// How far from its range something is seen again that travels with the robot, m.
fn fixed_m(range_m: f64) -> f64 {
    BODY_M + BODY_SHARE * range_m
}

/// What is cut out of all scans.
#[derive(Clone, Debug, Default)]
struct Cut {
    /// Range up to which readings of each beam are cut out, m; empty if no beam sees the body.
    limits_m: Vec<f64>,
    floor: Option<Line>,
}

impl Cut {
    fn is_empty(&self) -> bool {
        self.limits_m.is_empty() && self.floor.is_none()
    }

    fn apply(&self, scan: &mut LaserScan) {
        for (range_m, limit_m) in scan.ranges_m.iter_mut().zip(&self.limits_m) {
            if *range_m <= *limit_m {
                *range_m = f64::NAN;
            }
        }
        if let Some(floor) = &self.floor {
            for beam in 0..scan.ranges_m.len() {
                if floor.is_met_by(scan, beam) {
                    scan.ranges_m[beam] = f64::NAN;
                }
            }
        }
    }
}

/// Removes readings of what travels with the robot.
pub struct BodyReader<'a> {
    inner: Box<dyn LogReader + 'a>,
    waiting: VecDeque<LogFrame>,
    /// What the frames that wait show.
    trial: Trial,
    cut: Option<Cut>,
    remarks: Vec<Remark>,
    notes: LogNotes,
}

impl<'a> BodyReader<'a> {
    /// Wraps a reader.
    #[must_use]
    pub fn new(inner: Box<dyn LogReader + 'a>) -> Self {
        Self {
            inner,
            waiting: VecDeque::new(),
            trial: Trial::default(),
            cut: None,
            remarks: Vec::new(),
            notes: LogNotes::default(),
        }
    }

    /// Reads the first scans and finds what travels with the robot; goes on where it had to wait for a scan.
    fn find(&mut self) -> Result<Cut, LogError> {
        let first = self.waiting.front();
        if first.is_some_and(|first| first.odometry.is_none()) {
            return self.find_alone();
        }
        let mut beams = beams_of(&self.waiting);
        while self.waiting.len() < MAX_SCANS && beams < MAX_BEAMS && !self.trial.is_enough() {
            let frame = match self.inner.next_frame() {
                Ok(Some(frame)) => frame,
                Ok(None) => break,
                Err(LogError::Waiting) => return Err(LogError::Waiting),
                Err(error) if self.waiting.is_empty() => return Err(error),
                // The error recurs once these frames are consumed.
                Err(_) => break,
            };
            beams += frame.scan.ranges_m.len().max(1);
            let is_same_sensor = self.trial.add(frame.odometry, &frame.scan);
            let has_odometry = frame.odometry.is_some();
            let is_first = self.waiting.is_empty();
            self.waiting.push_back(frame);
            if !is_same_sensor {
                return Ok(Cut::default());
            }
            if !has_odometry && is_first {
                return self.find_alone();
            }
            if !has_odometry {
                break;
            }
        }
        let trial = mem::take(&mut self.trial);
        Ok(self.decided(&trial))
    }

    /// The same without odometry, after the first scan was read.
    fn find_alone(&mut self) -> Result<Cut, LogError> {
        let mut beams = beams_of(&self.waiting);
        while self.waiting.len() < MAX_ALONE && beams < MAX_BEAMS {
            let frame = match self.inner.next_frame() {
                Ok(Some(frame)) => frame,
                Err(LogError::Waiting) => return Err(LogError::Waiting),
                // An error recurs once these frames are consumed.
                Ok(None) | Err(_) => break,
            };
            beams += frame.scan.ranges_m.len().max(1);
            self.waiting.push_back(frame);
        }
        let steady = steady(&self.waiting);
        let mut trial = Trial::default();
        if steady.is_empty() {
            return Ok(Cut::default());
        }
        let mut slam: Option<Slam> = None;
        for LogFrame { stamp_s, scan, .. } in &self.waiting {
            let mut without = scan.clone();
            steady.apply(&mut without);
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
            if trial.is_enough() || !trial.add(body, scan) {
                break;
            }
        }
        Ok(self.decided(&trial))
    }

    fn decided(&mut self, trial: &Trial) -> Cut {
        let cut = trial.cut();
        if let (Some(scan), false) = (trial.last(), cut.limits_m.is_empty()) {
            self.remarks.push(body_remark(scan, &cut.limits_m));
        }
        self.remarks.extend(cut.floor.as_ref().map(floor_remark));
        cut
    }
}

/// Beams of all these frames, at least one each.
pub(crate) fn beams_of(frames: &VecDeque<LogFrame>) -> usize {
    let beams = frames.iter().map(|frame| frame.scan.ranges_m.len().max(1));
    beams.sum()
}

/// What may travel with the robot: beams that see the same near range in nearly all scans, and a line beyond which none
/// sees; nothing if the beams change.
fn steady(frames: &VecDeque<LogFrame>) -> Cut {
    let Some(first) = frames.front().map(|frame| &frame.scan) else {
        return Cut::default();
    };
    let is_changed = |frame: &LogFrame| frame.scan.ranges_m.len() != first.ranges_m.len();
    if frames.iter().any(is_changed) {
        return Cut::default();
    }
    let mut limits_m = Vec::new();
    let mut points = Vec::new();
    for beam in 0..first.ranges_m.len() {
        let scans = frames.iter().map(|frame| &frame.scan);
        let mut seen_m: Vec<f64> = scans
            .filter(|scan| scan.is_return(scan.ranges_m[beam]))
            .map(|scan| scan.ranges_m[beam])
            .collect();
        sort_numbers(&mut seen_m);
        let at = |share: f64| seen_m.get((share * seen_m.len() as f64) as usize).copied();
        let (Some(usual_m), Some(last_m)) = (at(0.5), at(1.0 - FARTHER)) else {
            limits_m.push(0.0);
            continue;
        };
        let near = |range_m: f64, within_m: f64| {
            let is_near = |seen_m: &&f64| (**seen_m - range_m).abs() < within_m;
            seen_m.iter().filter(is_near).count() as f64
        };
        let same = near(usual_m, BODY_M);
        let is_steady = usual_m < FARTHEST_M && same >= FIXED * frames.len() as f64;
        limits_m.push(if is_steady { f64::INFINITY } else { 0.0 });
        let on = near(last_m, fixed_m(last_m));
        let beyond = seen_m
            .iter()
            .filter(|seen_m| **seen_m >= last_m + fixed_m(last_m));
        if !is_steady && on >= FIXED * (on + beyond.count() as f64) {
            let (sin, cos) = math::sin_cos(first.bearing_rad(beam));
            points.push([last_m * cos, last_m * sin]);
        }
    }
    if !limits_m.contains(&f64::INFINITY) {
        limits_m.clear();
    }
    Cut {
        limits_m,
        floor: Line::of(&points),
    }
}

/// That the floor was cut out.
fn floor_remark(floor: &Line) -> Remark {
    Remark::mended(
        Part::Sensor,
        format!(
            "a straight line {:.2} m from the laser, toward {:.0}°, travels with the robot, and nothing is seen beyond it: the laser leans and sees the floor there. It was cut out; level the laser",
            floor.distance_m,
            // Not −0.
            floor.direction_rad.to_degrees().round() + 0.0
        ),
    )
}

/// That the body was cut out.
fn body_remark(scan: &LaserScan, limits_m: &[f64]) -> Remark {
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
        if self.cut.is_none() {
            let found = self.find();
            self.notes.clone_from(self.inner.notes());
            self.cut = Some(found?);
        }
        let frame = match self.waiting.pop_front() {
            Some(frame) => Ok(Some(frame)),
            None => self.inner.next_frame(),
        };
        self.notes.clone_from(self.inner.notes());
        self.notes.warnings.extend(self.remarks.iter().cloned());
        let mut frame = frame?;
        if let (Some(frame), Some(cut)) = (&mut frame, &self.cut) {
            cut.apply(&mut frame.scan);
        }
        Ok(frame)
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

#[cfg(test)]
mod tests;
