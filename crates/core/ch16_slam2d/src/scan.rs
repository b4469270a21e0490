//! Input of the estimator: frames of odometry and laser scans, and the clouds made of them.
//!
//! A [`Frame`] carries a [`LaserScan`] with its geometry. [`ScanPreparer`] drops beams without a return,
//! compensates the motion during the sweep, thins the points and estimates their normals. Frames may come
//! from a simulator, a log or a robot.

mod config;
mod error;
mod frame;
mod laser_scan;
mod prepare;
mod sweep;

pub use config::ScanConfig;
pub use error::FrameError;
pub use frame::is_finite;
pub use frame::{Frame, PreparedFrame};
pub use laser_scan::LaserScan;
pub use prepare::ScanPreparer;
pub use sweep::{MovingSweep, Sweep};
