//! 2. One Gauss–Newton step on the distances along the normals.
//!
//! **Task.** A point of the sweep may slide along its match's wall; only the distance across the wall counts:
//!
//! ```text
//! Σ (nₖ · (pₖ − qₖ))²        over the pairs that have a normal
//! ```
//!
//! **Formula** (Chen & Medioni 1992). Let c be the centroid of the points pₖ of these pairs, eₖ = nₖ · (pₖ − qₖ).
//! A small motion (tₓ, t_y, θ), which turns about c and then shifts, changes eₖ by `Jₖ · (tₓ, t_y, θ)` with
//!
//! ```text
//! Jₖ = (nₓ, n_y, (pₖ − c) × n)        a × b = aₓ b_y − a_y bₓ
//! H = Σ Jₖᵀ Jₖ        g = Σ Jₖᵀ eₖ        (H + λ I) x = −g
//! λ = 1e-4 · tr(H)/3 + 1e-12
//! ```
//!
//! The ridge λ allows no step in a direction that no normal sees. The returned motion turns about c, not about the
//! origin: `T(tₓ, t_y) · T(c) · R(θ) · T(c)⁻¹`.
//!
//! **Rules.** Pairs without a normal do not count. Fewer than three normals give the identity.

use ch16_listings::{Correspondence, SE2};

/// The step, a motion in the frame of the map: the new pose is `step * pose`.
#[must_use]
pub fn point_to_plane_step(pairs: &[Correspondence]) -> SE2 {
    crate::not_written("point_to_plane_step")
}
