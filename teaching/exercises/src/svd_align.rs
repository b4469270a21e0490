//! 1. The best rigid motion for given pairs.
//!
//! **Task.** `src[k]` and `dst[k]` are the same point in two frames, with noise. Find the motion `(R, t)` that
//! minimizes
//!
//! ```text
//! Σ ‖R pₖ + t − qₖ‖²
//! ```
//!
//! **Formula** (Arun, Huang, Blostein 1987; Umeyama 1991). With the means p̄ and q̄
//!
//! ```text
//! W = Σ (pₖ − p̄)(qₖ − q̄)ᵀ = U D Vᵀ
//! R = V diag(1, det(V Uᵀ)) Uᵀ        t = q̄ − R p̄
//! ```
//!
//! The determinant turns a reflection into the best rotation. In the plane you may instead solve for the angle:
//! the cost is one sinusoid in θ, and `atan2` of a sum of cross products and a sum of dot products is its minimum.
//!
//! **Rules.** Without pairs, return the identity.

use ch16_listings::SE2;
use nalgebra::Point2;

/// The motion that minimizes `Σ ‖R p + t − q‖²`; both slices have the same length.
#[must_use]
pub fn svd_align(src: &[Point2<f64>], dst: &[Point2<f64>]) -> SE2 {
    crate::not_written("svd_align")
}
