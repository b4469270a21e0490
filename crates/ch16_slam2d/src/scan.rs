//! What a robot hands to the estimator: frames of odometry and laser scans, and the clouds made of
//! them.
//!
//! A [`Frame`] carries a [`LaserScan`] with its geometry. [`ScanPreparer`] drops the beams that saw
//! nothing, undoes the motion during the sweep, thins the points and gives them normals. Nothing
//! here knows where the frames come from: a simulator, a log, a robot.

mod error;
mod frame;
mod laser_scan;
mod prepare;

pub use error::FrameError;
pub use frame::is_finite;
pub use frame::{Frame, PreparedFrame};
pub use laser_scan::LaserScan;
pub use prepare::{ScanConfig, ScanPreparer};
