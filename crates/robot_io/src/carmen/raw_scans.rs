//! Raw scans that wait for the odometry around their time.

use std::collections::VecDeque;

use pr_geom::SE2;

use crate::log::LogFrame;

/// A scan waits for so many others at most; then its odometry is the last one known.
const MOST_WAITING: usize = 64;

/// Scans without a pose, and the last two poses of the wheels.
#[derive(Debug, Default)]
pub struct RawScans {
    waiting: VecDeque<LogFrame>,
    before: Option<(f64, SE2)>,
    newest: Option<(f64, SE2)>,
}

impl RawScans {
    /// Takes a scan.
    pub fn push(&mut self, frame: LogFrame) {
        self.waiting.push_back(frame);
    }

    /// Takes a pose of the wheels.
    pub fn take_odometry(&mut self, stamp_s: f64, pose: SE2) {
        self.before = self.newest;
        self.newest = Some((stamp_s, pose));
    }

    /// Forgets the scans that wait.
    pub fn forget(&mut self) {
        self.waiting.clear();
    }

    /// The oldest scan, once odometry of its time is known, or none will come.
    pub fn pop(&mut self, is_done: bool) -> Option<LogFrame> {
        let stamp_s = self.waiting.front()?.stamp_s;
        let is_covered = self.newest.is_some_and(|(newest_s, _)| newest_s >= stamp_s);
        if !is_covered && !is_done && self.waiting.len() <= MOST_WAITING {
            return None;
        }
        let mut frame = self.waiting.pop_front()?;
        frame.odometry = self.pose_at(frame.stamp_s);
        Some(frame)
    }

    /// The pose at a time, by the twist between the poses around it.
    fn pose_at(&self, stamp_s: f64) -> Option<SE2> {
        let (newest_s, newest) = self.newest?;
        let Some((before_s, before)) = self.before else {
            return Some(newest);
        };
        let span_s = newest_s - before_s;
        if stamp_s >= newest_s || span_s <= 0.0 {
            return Some(newest);
        }
        let share = ((stamp_s - before_s) / span_s).max(0.0);
        Some(before * SE2::exp(&(before.between(&newest).log() * share)))
    }
}
