//! Noise of odometry, for motion without an accepted registration.

use nalgebra::{Matrix3, Vector3};
use pr_geom::{SE2, math};
use serde::{Deserialize, Serialize};

/// Smallest variance of a motion, m² or rad², which keeps the covariance invertible.
const MIN_VARIANCE: f64 = 1e-12;

/// Standard deviations of a measured motion, for edges whose registration was rejected.
///
/// `σ_xy = floor_m + per_metre · d + metre_per_rad · |θ|` along both axes and
/// `σ_θ = floor_rad + per_rad · |θ| + rad_per_metre · d`, for a motion of distance d (m) and turn θ
/// (rad).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionNoise {
    /// Of the position, constant part, m.
    pub floor_m: f64,
    /// Of the position, per metre.
    pub per_metre: f64,
    /// Of the position, per radian, m.
    pub metre_per_rad: f64,
    /// Of the heading, constant part, rad.
    pub floor_rad: f64,
    /// Of the heading, per radian.
    pub per_rad: f64,
    /// Of the heading, per metre, rad.
    pub rad_per_metre: f64,
}

impl Default for MotionNoise {
    /// Odometry of a common indoor robot: a tenth of the distance, a tenth of the turn.
    fn default() -> Self {
        Self {
            floor_m: 0.01,
            per_metre: 0.1,
            metre_per_rad: 0.02,
            floor_rad: 0.005,
            per_rad: 0.1,
            rad_per_metre: 0.05,
        }
    }
}

impl MotionNoise {
    /// A constant-velocity prediction instead of odometry: its error may be as large as the motion.
    #[must_use]
    pub fn without_odometry() -> Self {
        Self {
            floor_m: 0.1,
            per_metre: 1.0,
            metre_per_rad: 0.1,
            floor_rad: 0.1,
            per_rad: 1.0,
            rad_per_metre: 0.2,
        }
    }

    /// Standard deviations of the position (m) along each axis and of the heading (rad) of a motion.
    #[must_use]
    pub fn deviations(&self, motion: &SE2) -> (f64, f64) {
        let (distance, turn) = (math::norm2(motion.x(), motion.y()), motion.theta().abs());
        (
            self.floor_m + self.per_metre * distance + self.metre_per_rad * turn,
            self.floor_rad + self.per_rad * turn + self.rad_per_metre * distance,
        )
    }

    /// Covariance of a motion in the frame at its end, 3×3, translation first: m², rad².
    #[must_use]
    pub fn covariance(&self, motion: &SE2) -> Matrix3<f64> {
        let (xy, theta) = self.deviations(motion);
        let square = |sigma: f64| (sigma * sigma).max(MIN_VARIANCE);
        Matrix3::from_diagonal(&Vector3::new(square(xy), square(xy), square(theta)))
    }

    /// Covariance of two consecutive motions, in the frame at the end of the second: `Ad⁻¹ Σ Ad⁻ᵀ + Σ₂` with the
    /// adjoint of the second.
    #[must_use]
    pub fn then(&self, before: &Matrix3<f64>, motion: &SE2) -> Matrix3<f64> {
        let adjoint = motion.inverse().adjoint();
        adjoint * before * adjoint.transpose() + self.covariance(motion)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_rotates_the_covariance_of_earlier_motion() {
        let noise = MotionNoise {
            floor_m: 0.0,
            floor_rad: 0.0,
            per_rad: 0.0,
            metre_per_rad: 0.0,
            ..MotionNoise::default()
        };
        let sideways = Matrix3::from_diagonal(&Vector3::new(0.0, 4.0, 0.0));
        let quarter = SE2::new(0.0, 0.0, core::f64::consts::FRAC_PI_2);
        let after = noise.then(&sideways, &quarter);
        // 1e-11: the floor of the variances, and the cosine of a rounded quarter turn.
        assert!((after[(0, 0)] - 4.0).abs() < 1e-11);
        assert!(after[(1, 1)].abs() < 1e-11);
    }

    #[test]
    fn heading_uncertainty_adds_lateral_uncertainty_to_later_motion() {
        let noise = MotionNoise {
            floor_m: 0.0,
            per_metre: 0.0,
            floor_rad: 0.0,
            rad_per_metre: 0.0,
            ..MotionNoise::default()
        };
        let turned = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 0.01));
        let after = noise.then(&turned, &SE2::from_xy(3.0, 0.0));
        assert!((after[(1, 1)] - 0.01 * 9.0).abs() < 1e-11);
        assert!(after[(0, 0)].abs() < 1e-11);
    }
}
