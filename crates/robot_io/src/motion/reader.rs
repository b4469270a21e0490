//! Compares the first scans of a log with its odometry and corrects what is wrong.

use std::collections::VecDeque;

use pr_geom::SE2;

use super::{Comparison, Motion};
use crate::laser_mount::{LaserMount, flip};
use crate::log::{LogError, LogFrame, LogNotes, LogReader};
use crate::odometry_poses::OdometryPoses;
use crate::own_body::BodyReader;
use crate::remark::Remark;

/// Most scans that are compared, and most beams together: they are kept in memory.
const MAX_SCANS: usize = 2000;
const MAX_BEAMS: usize = 1 << 21;
/// Most scans that wait for late odometry: more than any sensor takes in a second.
const MAX_LATE: usize = 200;

/// A corrected mounting.
struct CorrectedMount {
    /// The stated mounting.
    stated: SE2,
    /// The corrected one.
    mount: LaserMount,
    /// Whether the order of the beams is reversed.
    is_turned_over: bool,
}

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

/// Reads a log, compares its first scans with its odometry, and corrects what is clearly wrong.
pub struct ComparedReader<'a> {
    inner: Box<dyn LogReader + 'a>,
    /// Whether the mounting was set by the user and must not change.
    is_mount_fixed: bool,
    /// Whether the run ignores odometry.
    ignores_odometry: bool,
    waiting: VecDeque<LogFrame>,
    /// Result of an earlier comparison.
    known: Option<Motion>,
    motion: Option<Motion>,
    mount: Option<CorrectedMount>,
    metres: f64,
    is_still: bool,
    late: Option<Late>,
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
            ignores_odometry: false,
            waiting: VecDeque::new(),
            known: None,
            motion: None,
            mount: None,
            metres: 1.0,
            is_still: false,
            late: None,
            notes: LogNotes::default(),
            remarks: Vec::new(),
        }
    }

    /// Suppresses findings about odometry, for a run that ignores it.
    #[must_use]
    pub fn ignoring_odometry(mut self, ignores_odometry: bool) -> Self {
        self.ignores_odometry = ignores_odometry;
        self
    }

    /// Reuses the result of an earlier comparison of the same log.
    #[must_use]
    pub fn with_motion(mut self, motion: Motion) -> Self {
        self.known = Some(motion);
        self
    }

    /// The result of the comparison; `None` before the first frame.
    #[must_use]
    pub fn motion(&self) -> Option<&Motion> {
        self.motion.as_ref()
    }

    /// Reads and compares the first scans.
    fn compare(&mut self) -> Result<(), LogError> {
        let mut comparison: Option<Comparison> = None;
        let mut beams = 0;
        let mut has_odometry = false;
        while self.waiting.len() < MAX_SCANS && beams < MAX_BEAMS {
            let frame = match self.inner.next_frame() {
                Ok(Some(frame)) => frame,
                Ok(None) => break,
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
            let comparing = comparison.get_or_insert_with(|| Comparison::new(&frame));
            comparing.add(&frame);
            let is_enough = comparing.is_enough();
            self.waiting.push_back(frame);
            if is_enough {
                break;
            }
        }
        let stated = self
            .waiting
            .front()
            .map(|first| first.scan.body_from_sensor);
        let found = self.known.take().or_else(|| {
            let compared = comparison.filter(|_| has_odometry)?;
            let mut motion = Motion::from_stretches(&compared.stretches, stated?);
            motion.compare_turns(&compared.headings);
            if self.ignores_odometry {
                motion.keep_mounting();
            }
            Some(motion)
        });
        let motion = found.unwrap_or_default();
        if let Some(stated) = stated {
            let recorded = self.inner.notes().laser;
            let mount = recorded.unwrap_or(LaserMount {
                body_from_sensor: stated,
                is_flipped: false,
            });
            self.remarks = motion.remarks(mount, !self.is_mount_fixed);
            if !self.is_mount_fixed {
                let mended = motion.mended_mount(mount);
                self.mount = mended.map(|mended| CorrectedMount {
                    stated,
                    mount: mended,
                    is_turned_over: mended.is_flipped != mount.is_flipped,
                });
            }
            self.metres = motion.metres().unwrap_or(1.0);
            self.is_still = motion.is_still();
            self.late = motion.lag_s.map(Late::by);
        }
        self.motion = Some(motion);
        Ok(())
    }

    fn mended(&self, mut frame: LogFrame) -> LogFrame {
        if let Some(mended) = &self.mount
            && frame.scan.body_from_sensor == mended.stated
        {
            if mended.is_turned_over {
                flip(&mut frame.scan);
            }
            frame.scan.body_from_sensor = mended.mount.body_from_sensor;
        }
        if self.is_still {
            frame.odometry = None;
        }
        if self.metres != 1.0 {
            frame.odometry = frame
                .odometry
                .map(|pose| SE2::new(pose.x() * self.metres, pose.y() * self.metres, pose.theta()));
        }
        frame
    }

    /// The next frame, before odometry's lag is corrected.
    fn next_mended(&mut self) -> Result<Option<LogFrame>, LogError> {
        if let Some(frame) = self.waiting.pop_front() {
            return Ok(Some(self.mended(frame)));
        }
        let frame = self.inner.next_frame();
        self.copy_notes();
        Ok(frame?.map(|frame| self.mended(frame)))
    }

    fn copy_notes(&mut self) {
        self.notes.clone_from(self.inner.notes());
        self.notes.warnings.extend(self.remarks.iter().cloned());
        if let Some(mended) = &self.mount {
            self.notes.laser = Some(mended.mount);
        }
    }
}

impl LogReader for ComparedReader<'_> {
    fn next_frame(&mut self) -> Result<Option<LogFrame>, LogError> {
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

    fn notes(&self) -> &LogNotes {
        &self.notes
    }
}
