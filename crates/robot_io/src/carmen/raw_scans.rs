//! Raw scans that wait for the odometry around their time.

use std::collections::VecDeque;

use pr_geom::SE2;

use crate::log::LogFrame;
use crate::wheel_poses::WheelPoses;

/// A scan waits for so many others at most; then its odometry is the last one known.
const MOST_WAITING: usize = 64;

/// Scans without a pose, and the last poses of the wheels: a scan may be logged after wheels that are
/// later than it.
#[derive(Debug, Default)]
pub struct RawScans {
    waiting: VecDeque<LogFrame>,
    wheels: WheelPoses,
}

impl RawScans {
    /// Takes a scan.
    pub fn push(&mut self, frame: LogFrame) {
        self.waiting.push_back(frame);
    }

    /// Takes a pose of the wheels.
    pub fn take_odometry(&mut self, stamp_s: f64, pose: SE2) {
        self.wheels.push(stamp_s, pose);
    }

    /// Scans that wait.
    pub fn waiting(&self) -> usize {
        self.waiting.len()
    }

    /// Forgets the scans that wait.
    pub fn forget(&mut self) {
        self.waiting.clear();
    }

    /// The oldest scan, once odometry of its time is known, or none will come.
    pub fn pop(&mut self, is_done: bool) -> Option<LogFrame> {
        let stamp_s = self.waiting.front()?.stamp_s;
        let is_covered = self.wheels.reaches(stamp_s);
        if !is_covered && !is_done && self.waiting.len() <= MOST_WAITING {
            return None;
        }
        let mut frame = self.waiting.pop_front()?;
        frame.odometry = self.wheels.at(frame.stamp_s);
        Some(frame)
    }
}
