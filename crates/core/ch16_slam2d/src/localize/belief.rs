//! Posterior of the pose while tracking.

use nalgebra::Matrix3;
use pr_geom::SE2;

/// The posterior of the pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Belief {
    pub pose: SE2,
    pub covariance: Matrix3<f64>,
    /// Consecutive scans that do not fit.
    pub misses: usize,
    /// Running average of the scan's score.
    pub usual_score: f64,
    /// Consecutive scans that fit clearly worse than usual; no longer reset once there are too many.
    pub drops: usize,
}
