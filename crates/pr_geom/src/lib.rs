//! Rigid motions of the plane (Chapter 3): the group SE(2), its tangent space, and angles.
//!
//! A pose is `(x, y, θ)`, in metres and radians, with θ in (−π, π]. A tangent vector is
//! `(v_x, v_y, ω)`: **translation first**, everywhere in this workspace. Perturbations act on the
//! right: `T ⊞ δ = T exp(δ)`.
//!
//! Source: Solà, Deray, Atchuthan, "A micro Lie theory for state estimation in robotics", 2018.

pub mod angle;
pub mod math;
pub mod se2;

pub use angle::wrap_angle;
pub use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
pub use se2::{Rotation, SE2, Translation};
