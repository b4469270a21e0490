//! 3. The residual of an edge and its Jacobians.

use ch16_listings::SE2;
use nalgebra::{Matrix3, Vector3};

/// `e = log(Z⁻¹ Tᵢ⁻¹ Tⱼ)`.
#[must_use]
pub fn residual(from: &SE2, to: &SE2, z: &SE2) -> Vector3<f64> {
    (z.inverse() * from.inverse() * *to).log()
}

/// `(−Ad(Z⁻¹), I)`.
#[must_use]
pub fn jacobians(z: &SE2) -> (Matrix3<f64>, Matrix3<f64>) {
    (-z.inverse().adjoint(), Matrix3::identity())
}
