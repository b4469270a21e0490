//! What can be wrong with a frame.

use thiserror::Error;

/// Why a frame was refused; the estimator is as it was before.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FrameError {
    /// A number of the geometry is unusable.
    #[error("the scan's {name} is {value}; give {expected}")]
    Geometry {
        /// Which number.
        name: &'static str,
        /// What it was.
        value: f64,
        /// What it has to be.
        expected: &'static str,
    },
    /// The time stamp is no time after the last frame's.
    #[error(
        "the frame's stamp {stamp_s} s does not follow the last one, {last_s} s; sort the frames by time"
    )]
    Stamp {
        /// Stamp of the frame, s.
        stamp_s: f64,
        /// Stamp of the frame before it, s; minus infinity before the first.
        last_s: f64,
    },
    /// The odometry is not a motion, or leads out of all numbers.
    #[error(
        "the odometry of the frame at {stamp_s} s leads to a pose that is not finite; leave it out"
    )]
    Odometry {
        /// Stamp of the frame, s.
        stamp_s: f64,
    },
}
