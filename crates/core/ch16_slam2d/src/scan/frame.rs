//! One frame of measurements.

use std::sync::Arc;

use pr_geom::SE2;

use super::{FrameError, LaserScan, Sweep};
use crate::cloud::PointCloud;

/// A scan and the odometry since the last one.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Time of the scan's first beam, s.
    pub stamp_s: f64,
    /// Motion of the body since the last frame by odometry: the present body frame in the previous one.
    /// Without it the estimator predicts constant velocity.
    pub odometry: Option<SE2>,
    /// The scan.
    pub scan: LaserScan,
}

impl Frame {
    /// Validates all numbers.
    ///
    /// # Errors
    /// The first invalid number, and what is expected.
    pub fn validate(&self) -> Result<(), FrameError> {
        check_motion(self.stamp_s, self.odometry.as_ref())?;
        self.scan.validate()
    }
}

/// A frame whose scan is already a cloud, so it can be reused.
#[derive(Clone, Debug, PartialEq)]
pub struct PreparedFrame {
    /// Time of the scan's first beam, s.
    pub stamp_s: f64,
    /// Motion of the body since the last frame; see [`Frame::odometry`].
    pub odometry: Option<SE2>,
    /// The scan's points in the body's frame at the stamp, thinned, with normals.
    pub cloud: Arc<PointCloud>,
    /// The scan before deskewing if its beams differ in time and no odometry measures the motion meanwhile: the
    /// registration finds that together with the pose.
    pub sweep: Option<Arc<Sweep>>,
}

impl PreparedFrame {
    /// Validates stamp and odometry.
    ///
    /// # Errors
    /// [`FrameError::Stamp`] or [`FrameError::Odometry`].
    pub fn validate(&self) -> Result<(), FrameError> {
        check_motion(self.stamp_s, self.odometry.as_ref())
    }

    /// Validates the frame as successor of one at `last_stamp_s`, s, whose estimate is `world_from_body`; returns
    /// the time since then, s.
    ///
    /// # Errors
    /// [`FrameError::Stamp`] if it is not later, [`FrameError::Odometry`] if the pose after its motion is not finite.
    pub fn seconds_after(
        &self,
        last_stamp_s: f64,
        world_from_body: &SE2,
    ) -> Result<f64, FrameError> {
        self.validate()?;
        let stamp_s = self.stamp_s;
        let dt_s = stamp_s - last_stamp_s;
        if dt_s <= 0.0 {
            return Err(FrameError::Stamp {
                stamp_s,
                last_s: last_stamp_s,
            });
        }
        let leads_nowhere = |motion: SE2| !is_finite(&(*world_from_body * motion));
        if self.odometry.is_some_and(leads_nowhere) {
            return Err(FrameError::Odometry { stamp_s });
        }
        Ok(dt_s)
    }
}

/// Whether all components of a pose are finite.
#[must_use]
pub fn is_finite(pose: &SE2) -> bool {
    pose.to_array().iter().all(|value| value.is_finite())
}

fn check_motion(stamp_s: f64, odometry: Option<&SE2>) -> Result<(), FrameError> {
    if !stamp_s.is_finite() {
        return Err(FrameError::Stamp {
            stamp_s,
            last_s: f64::NEG_INFINITY,
        });
    }
    match odometry {
        Some(motion) if !is_finite(motion) => Err(FrameError::Odometry { stamp_s }),
        _ => Ok(()),
    }
}
