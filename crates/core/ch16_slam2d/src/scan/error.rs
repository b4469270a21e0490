//! Errors of a frame.

use thiserror::Error;

/// Why a frame was rejected; the estimator is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FrameError {
    /// A number of the geometry is unusable.
    #[error("the scan's {name} is {value}; give {expected}")]
    Geometry {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is expected.
        expected: &'static str,
    },
    /// The time stamp is not after that of the last frame.
    #[error(
        "the frame's stamp {stamp_s} s is not after the last one, {last_s} s; sort the frames by time"
    )]
    Stamp {
        /// Stamp of the frame, s.
        stamp_s: f64,
        /// Stamp of the previous frame, s; minus infinity before the first.
        last_s: f64,
    },
    /// The odometry is not finite, or the pose after it is not.
    #[error(
        "the odometry of the frame at {stamp_s} s leads to a pose that is not finite; leave it out"
    )]
    Odometry {
        /// Stamp of the frame, s.
        stamp_s: f64,
    },
}
