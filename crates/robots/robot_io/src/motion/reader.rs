//! Compares the first scans of a log with its odometry and corrects what is wrong.

use std::collections::VecDeque;

use super::repairs::{Repairs, TurnedPath};
use super::trial::Trial;
use super::{Comparison, MotionComparison, OdometryUse};
use crate::laser_mount::LaserMount;
use crate::log::{LogError, LogFrame, LogNotes, LogOptions, LogReader};
use crate::odometry_poses::OdometryPoses;
use crate::own_body::{BodyReader, beams_of};
use crate::remark::Remark;

/// Most scans that are compared, and most beams together: they are kept in memory.
const MAX_SCANS: usize = 2000;
const MAX_BEAMS: usize = 1 << 21;
/// Most scans that wait for late odometry: more than any sensor takes in a second.
const MAX_LATE: usize = 200;

/// Odometry with late stamps: each scan waits for the odometry of its time.
struct Late {
    by_s: f64,
    odometry: OdometryPoses,
    waiting: VecDeque<LogFrame>,
    is_over: bool,
}

impl Late {
    fn by(by_s: f64) -> Self {
        Self {
            by_s,
            odometry: OdometryPoses::default(),
            waiting: VecDeque::new(),
            is_over: false,
        }
    }

    /// The next frame for which odometry has arrived.
    fn next(&mut self) -> Option<LogFrame> {
        let at_s = self.waiting.front()?.stamp_s + self.by_s;
        let is_full = self.waiting.len() > MAX_LATE;
        if !self.is_over && !is_full && !self.odometry.reaches(at_s) {
            return None;
        }
        let mut frame = self.waiting.pop_front()?;
        frame.odometry = self.odometry.at(at_s);
        Some(frame)
    }

    fn add(&mut self, frame: Option<LogFrame>) {
        let Some(frame) = frame else {
            self.is_over = true;
            return;
        };
        if let Some(pose) = frame.odometry {
            self.odometry.push(frame.stamp_s, pose);
        }
        self.waiting.push_back(frame);
    }
}

/// Reads a log, compares its first scans with its odometry, and corrects what a trial shows to be wrong.
pub struct ComparedReader<'a> {
    inner: Box<dyn LogReader + 'a>,
    /// Whether the mounting was set by the user and must not change.
    is_mount_fixed: bool,
    odometry: OdometryUse,
    waiting: VecDeque<LogFrame>,
    /// What the frames that wait show.
    comparison: Option<Comparison>,
    /// Result of an earlier comparison.
    known: Option<MotionComparison>,
    motion: Option<MotionComparison>,
    repairs: Repairs,
    path: TurnedPath,
    late: Option<Late>,
    /// The frame after the last one, or why there is none.
    ahead: Option<Result<LogFrame, LogError>>,
    notes: LogNotes,
    remarks: Vec<Remark>,
}

impl<'a> ComparedReader<'a> {
    /// Wraps `inner`; `is_mount_fixed` states that the mounting was set by the user and must not change.
    #[must_use]
    pub fn new(inner: Box<dyn LogReader + 'a>, is_mount_fixed: bool) -> Self {
        Self {
            inner: Box::new(BodyReader::new(inner)),
            is_mount_fixed,
            odometry: OdometryUse::Check,
            waiting: VecDeque::new(),
            comparison: None,
            known: None,
            motion: None,
            repairs: Repairs::default(),
            path: TurnedPath::default(),
            late: None,
            ahead: None,
            notes: LogNotes::default(),
            remarks: Vec::new(),
        }
    }

    /// Starts a comparison of a log that was opened with these options.
    #[must_use]
    pub fn chosen(inner: Box<dyn LogReader + 'a>, options: &LogOptions) -> Self {
        Self::new(inner, options.laser.is_some()).with_odometry(options.odometry)
    }

    /// Takes the odometry as chosen.
    #[must_use]
    pub fn with_odometry(mut self, odometry: OdometryUse) -> Self {
        self.odometry = odometry;
        self
    }

    /// Reuses the result of an earlier comparison of the same log.
    #[must_use]
    pub fn with_motion(mut self, motion: MotionComparison) -> Self {
        self.known = Some(motion);
        self
    }

    /// The result of the comparison; `None` before the first frame.
    #[must_use]
    pub fn motion(&self) -> Option<&MotionComparison> {
        self.motion.as_ref()
    }

    /// Number of frames that were read and wait for their turn.
    #[must_use]
    pub fn waiting(&self) -> usize {
        let late = self.late.as_ref().map_or(0, |late| late.waiting.len());
        self.waiting.len() + late
    }

    /// Reads and compares the first scans; goes on where it had to wait for one.
    fn compare(&mut self) -> Result<(), LogError> {
        let mut beams = beams_of(&self.waiting);
        let mut has_odometry = self.waiting.iter().any(|frame| frame.odometry.is_some());
        while self.waiting.len() < MAX_SCANS && beams < MAX_BEAMS {
            let frame = match self.next_recorded() {
                Ok(Some(frame)) => frame,
                Ok(None) => break,
                Err(LogError::Waiting) => return Err(LogError::Waiting),
                Err(error) if self.waiting.is_empty() => return Err(error),
                // The error recurs once these frames are consumed.
                Err(_) => break,
            };
            beams += frame.scan.ranges_m.len().max(1);
            has_odometry |= frame.odometry.is_some();
            if self.known.is_some() {
                self.waiting.push_back(frame);
                break;
            }
            let comparing = self
                .comparison
                .get_or_insert_with(|| Comparison::new(&frame));
            comparing.add(&frame);
            let is_enough = comparing.is_enough();
            self.waiting.push_back(frame);
            if is_enough {
                break;
            }
        }
        let stated = self.waiting.front().map(|first| LaserMount {
            body_from_sensor: first.scan.body_from_sensor,
            is_flipped: false,
        });
        let Some(stated) = stated else {
            self.motion = Some(MotionComparison::default());
            return Ok(());
        };
        let recorded = self.inner.notes().laser.unwrap_or(stated);
        let mount = LaserMount {
            is_flipped: recorded.is_flipped,
            ..stated
        };
        let comparison = self.comparison.take();
        let found = self.known.take().or_else(|| {
            let compared = comparison?;
            let mut motion = MotionComparison::default();
            if has_odometry {
                motion =
                    MotionComparison::from_stretches(&compared.stretches, stated.body_from_sensor);
                motion.compare_turns(&compared.headings);
            }
            motion.compare_sweeps(compared.skew, &compared.sweeps);
            if matches!(self.odometry, OdometryUse::Force | OdometryUse::Ignore) {
                motion.keep_mounting();
            }
            if !motion.findings().is_empty() {
                motion.decide(&Trial::new(&self.waiting, &compared.steps_s), mount);
            }
            Some(motion)
        });
        let motion = found.unwrap_or_default();
        self.remarks = motion.remarks(mount, self.is_mount_fixed);
        self.repairs = motion.repairs(mount, self.is_mount_fixed);
        if self.odometry == OdometryUse::Ignore {
            self.repairs.drops_odometry = true;
        }
        self.late = self.repairs.late_s.map(Late::by);
        self.motion = Some(motion);
        Ok(())
    }

    /// The next frame of the log, with its odometry as chosen.
    fn next_recorded(&mut self) -> Result<Option<LogFrame>, LogError> {
        let frame = self.inner.next_frame()?;
        Ok(frame.map(|mut frame| {
            frame.odometry = frame.odometry.map(|pose| self.odometry.pose(pose));
            frame
        }))
    }

    /// The next frame, before odometry's lag is corrected.
    fn next_mended(&mut self) -> Result<Option<LogFrame>, LogError> {
        if let Some(frame) = self.waiting.pop_front() {
            return Ok(Some(self.repairs.apply(frame, &mut self.path)));
        }
        let frame = self.next_recorded();
        self.copy_notes();
        Ok(frame?.map(|frame| self.repairs.apply(frame, &mut self.path)))
    }

    fn copy_notes(&mut self) {
        self.notes.clone_from(self.inner.notes());
        self.notes.warnings.extend(self.remarks.iter().cloned());
        if let Some(mended) = self.repairs.mount() {
            self.notes.laser = Some(mended);
        }
    }

    /// The next frame, before the motion during its sweep is known.
    fn next_compared(&mut self) -> Result<Option<LogFrame>, LogError> {
        if self.motion.is_none() {
            let compared = self.compare();
            self.copy_notes();
            compared?;
        }
        loop {
            if let Some(frame) = self.late.as_mut().and_then(Late::next) {
                return Ok(Some(frame));
            }
            let frame = self.next_mended()?;
            match &mut self.late {
                None => return Ok(frame),
                Some(late) if late.is_over => return Ok(None),
                Some(late) => late.add(frame),
            }
        }
    }
}

impl LogReader for ComparedReader<'_> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
        let next = match self.ahead.take() {
            Some(ahead) => Some(ahead?),
            None => self.next_compared()?,
        };
        let Some(mut frame) = next else {
            return Ok(None);
        };
        if frame.scan.beam_interval_s > 0.0 && frame.odometry.is_some() {
            let next = self.next_compared();
            if let Err(LogError::Waiting) = next {
                self.ahead = Some(Ok(frame));
                return Err(LogError::Waiting);
            }
            self.ahead = next.transpose();
            if let Some(Ok(next)) = &self.ahead {
                frame.scan.velocity = frame.velocity_until(next);
            }
        }
        Ok(Some(frame))
    }

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}

#[cfg(test)]
mod tests {
    use crate::json_log::JsonLogReader;

    use super::*;

    #[test]
    fn the_velocity_in_a_sweep_is_that_of_the_odometry_up_to_the_next_scan() {
        // 0.1 m in the first interval, 0.3 m in the second; a sweep of 0.2 s.
        let line = |stamp_s: f64, x: f64| {
            format!(
                r#"{{"stamp_s":{stamp_s},"odometry":[{x},0,0],"first_angle_rad":0,"angle_step_rad":1,"beam_interval_s":0.1,"ranges_m":[1,1,1]}}"#
            ) + "\n"
        };
        let text = line(0.0, 0.0) + &line(0.5, 0.1) + &line(1.0, 0.4);
        let inner = Box::new(JsonLogReader::new(text.as_bytes(), "x"));
        let mut reader = ComparedReader::new(inner, false);
        let mut forward = Vec::new();
        while let Some(frame) = reader.next_frame().unwrap() {
            forward.push(frame.scan.velocity.map(|velocity| velocity.x));
        }
        assert!((forward[0].unwrap() - 0.2).abs() < 1e-12, "{forward:?}");
        assert!((forward[1].unwrap() - 0.6).abs() < 1e-12, "{forward:?}");
        assert_eq!(forward[2], None);
    }
}
