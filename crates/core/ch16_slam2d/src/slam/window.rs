//! The last few scans, on which the next one is registered.

use std::sync::Arc;

use pr_geom::SE2;
use serde::{Deserialize, Serialize};

use crate::cloud::PointCloud;

/// A sweep of the local map.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindowScan {
    /// The frame in which it was taken.
    pub frame: usize,
    /// Its estimated pose: `world_from_body`.
    pub pose: SE2,
}

/// The last few scans with their poses, oldest first.
#[derive(Clone, Debug, Default)]
pub struct ScanWindow {
    sweeps: Vec<WindowScan>,
    scans: Vec<Arc<PointCloud>>,
}

impl ScanWindow {
    /// A window of these sweeps and their scans, in the same order.
    pub(super) fn new(sweeps: &[WindowScan], scans: &[Arc<PointCloud>]) -> Self {
        Self {
            sweeps: sweeps.to_vec(),
            scans: scans.to_vec(),
        }
    }

    /// Frame and pose of each scan.
    #[must_use]
    pub fn sweeps(&self) -> &[WindowScan] {
        &self.sweeps
    }

    /// The scans, body frame.
    #[must_use]
    pub fn scans(&self) -> &[Arc<PointCloud>] {
        &self.scans
    }

    /// Each scan with its `world_from_body`.
    pub fn posed_scans(&self) -> impl Iterator<Item = (&SE2, &Arc<PointCloud>)> {
        let poses = self.sweeps.iter().map(|sweep| &sweep.pose);
        poses.zip(&self.scans)
    }

    pub(super) fn push(&mut self, frame: usize, pose: SE2, scan: Arc<PointCloud>) {
        self.sweeps.push(WindowScan { frame, pose });
        self.scans.push(scan);
    }

    pub(super) fn drop_oldest(&mut self) {
        self.sweeps.remove(0);
        self.scans.remove(0);
    }

    /// Moves all poses by `correction`, applied on the left.
    pub(super) fn correct(&mut self, correction: &SE2) {
        for sweep in &mut self.sweeps {
            sweep.pose = *correction * sweep.pose;
        }
    }
}
