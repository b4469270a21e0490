//! Scans that wait for the odometry of their time.

use std::collections::VecDeque;

use crate::log::LogFrame;

/// A scan waits for so many others at most; then its odometry is the last one known.
const MOST_WAITING: usize = 64;

/// A scan with the frame that it was taken in.
#[derive(Clone, Debug)]
pub struct WaitingScan {
    /// The scan without odometry and mounting.
    pub frame: LogFrame,
    /// The sensor's frame.
    pub sensor: String,
}

/// Scans in the order of the file.
#[derive(Clone, Debug, Default)]
pub struct WaitingScans {
    scans: VecDeque<WaitingScan>,
}

impl WaitingScans {
    /// Takes a scan.
    pub fn push(&mut self, scan: WaitingScan) {
        self.scans.push_back(scan);
    }

    /// The oldest one.
    pub fn first(&self) -> Option<&WaitingScan> {
        self.scans.front()
    }

    /// Takes the oldest one out.
    pub fn pop(&mut self) -> Option<WaitingScan> {
        self.scans.pop_front()
    }

    /// Whether the oldest one has waited long enough.
    pub fn is_full(&self) -> bool {
        self.scans.len() > MOST_WAITING
    }
}
