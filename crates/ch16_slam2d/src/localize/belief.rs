//! What is localized of the pose of a robot that is followed.

use nalgebra::Matrix3;
use pr_geom::SE2;

/// What is localized of the pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Belief {
    pub pose: SE2,
    pub covariance: Matrix3<f64>,
    /// Scans in a row that do not fit.
    pub misses: usize,
    /// Share of a scan that fits, where nothing is doubted.
    pub usual_score: f64,
    /// Scans in a row that fit clearly worse than usual; it stays once there are too many.
    pub drops: usize,
}
