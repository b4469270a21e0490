#![doc = include_str!("../README.md")]
//!
//! Rigid motions of the plane (Chapter 3): the group SE(2), its tangent space, angles, and the seeded
//! random numbers of all noise.
//!
//! A pose is `(x, y, θ)`, in metres and radians, with θ in (−π, π]. A tangent vector is
//! `(v_x, v_y, ω)`: **translation first**, everywhere in this workspace. Perturbations act on the
//! right: `T ⊞ δ = T exp(δ)`. A position is a `Point2`, a displacement or a direction a `Vector2`.
//!
//! Source: Solà, Deray, Atchuthan, "A micro Lie theory for state estimation in robotics", 2018.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

pub mod angle;
pub mod math;
mod order;
pub mod rng;
pub mod se2;

pub use angle::wrap_angle;
pub use nalgebra::{Matrix2, Matrix3, Point2, Vector2, Vector3};
pub use order::{order_by, sort_numbers, sort_pairs, sort_ranked};
pub use rng::Rng;
pub use se2::{Rotation, SE2, twist_size};
