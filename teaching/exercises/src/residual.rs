//! 3. The residual of an edge, and its Jacobians.
//!
//! **Task.** An edge of the graph measured Z, the pose of node j in the frame of node i. Write the residual, and its
//! Jacobians for perturbations on the right, `T ⊞ δ = T exp(δ)`, translation first.
//!
//! **Formula.**
//!
//! ```text
//! e = log(Z⁻¹ Tᵢ⁻¹ Tⱼ)
//! ∂e/∂δⱼ ≈ I        ∂e/∂δᵢ ≈ −Ad(Z⁻¹)
//! ```
//!
//! They leave out the factors `J_r⁻¹(e)` at j and `J_l⁻¹(e)` at i, which are I if e is zero. Otherwise, the result moves
//! by O(e²); a residual that is wrong to first order moves it by O(e) (exercise 3 of the page).

use ch16_listings::SE2;
use nalgebra::{Matrix3, Vector3};

/// `e`, in m, m, rad, for the poses `from` (Tᵢ) and `to` (Tⱼ) and the measurement `z` (Z).
#[must_use]
pub fn residual(from: &SE2, to: &SE2, z: &SE2) -> Vector3<f64> {
    crate::not_written("residual")
}

/// `(∂e/∂δᵢ, ∂e/∂δⱼ)`.
#[must_use]
pub fn jacobians(z: &SE2) -> (Matrix3<f64>, Matrix3<f64>) {
    crate::not_written("residual")
}
