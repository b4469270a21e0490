//! The information of edges as in the chapter's figures.

use nalgebra::Matrix3;

use super::TrustConfig;
use crate::icp::{Pair, icp_information_along};

/// In which frame the information of an edge is expressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum InformationFrame {
    /// As the chapter's figures were computed: about the centroid of the pairs. An odometry edge is
    /// rotated by the heading of its source, a loop by the world heading of its candidate.
    ///
    /// The residual lives at the edge's target, so this is correct only if all of these headings are
    /// equal: in a corridor with a candidate facing 90° the axes of the information are swapped. Edges
    /// of rejected registrations get the information of the available pairs.
    Chapter,
    /// That of `e = log(Z⁻¹ Tᵢ⁻¹ Tⱼ)`: in the tangent space at the edge's target j, about j's origin.
    ///
    /// Edges of rejected registrations get that of the odometry.
    #[default]
    Exact,
}

/// The information of `pairs` as [`InformationFrame::Chapter`] rotates it, by the heading `theta_rad`.
#[must_use]
pub fn chapter_information(pairs: &[Pair], theta_rad: f64, trust: &TrustConfig) -> Matrix3<f64> {
    icp_information_along(pairs, trust.sigma_m, trust.covariance_scale, theta_rad)
}
