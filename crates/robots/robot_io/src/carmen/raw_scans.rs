//! Raw scans that wait for odometry at their stamps.

use std::collections::VecDeque;

use pr_geom::SE2;

use crate::log::LogFrame;
use crate::odometry_poses::OdometryPoses;

/// Most scans that wait; beyond it, a scan takes the last known odometry.
const MAX_WAITING: usize = 64;

/// Scans without a pose, and the latest odometry poses: a scan may be logged after odometry that is newer than it.
#[derive(Debug, Default)]
pub struct RawScans {
    waiting: VecDeque<LogFrame>,
    odometry: OdometryPoses,
}

impl RawScans {
    pub fn push(&mut self, frame: LogFrame) {
        self.waiting.push_back(frame);
    }

    /// Takes an odometry pose.
    pub fn add_odometry(&mut self, stamp_s: f64, pose: SE2) {
        self.odometry.push(stamp_s, pose);
    }

    /// Number of waiting scans.
    pub fn waiting(&self) -> usize {
        self.waiting.len()
    }

    /// Drops the waiting scans.
    pub fn forget(&mut self) {
        self.waiting.clear();
    }

    /// The oldest scan, once odometry covers its stamp or no more will come.
    pub fn pop(&mut self, is_done: bool) -> Option<LogFrame> {
        let stamp_s = self.waiting.front()?.stamp_s;
        let is_covered = self.odometry.reaches(stamp_s);
        if !is_covered && !is_done && self.waiting.len() <= MAX_WAITING {
            return None;
        }
        let mut frame = self.waiting.pop_front()?;
        frame.odometry = self.odometry.at(frame.stamp_s);
        Some(frame)
    }
}
