//! The information of edges as the chapter's figures have it.

use nalgebra::Matrix3;

use crate::icp::{Pair, icp_information_along};
use crate::matching::TrustConfig;

/// In which frame the information of an edge is expressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum InformationFrame {
    /// As the chapter's figures were computed: about the centroid of the pairs, an odometry edge
    /// turned by the heading of its source, a loop by the heading that its candidate has in the world.
    ///
    /// The residual lives at the edge's target, so this is right only where all of these headings
    /// are alike: a corridor whose candidate faces 90° gets its certainty the wrong way round. Edges
    /// of refused registrations get the information of what pairs there were.
    Chapter,
    /// That of `e = log(Z⁻¹ Tᵢ⁻¹ Tⱼ)`: in the tangent space at the edge's target j, about j's origin.
    ///
    /// Edges of refused registrations get that of the odometry.
    #[default]
    Exact,
}

/// The information of `pairs` as [`InformationFrame::Chapter`] turns it, by the heading `theta_rad`.
#[must_use]
pub fn chapter_information(pairs: &[Pair], theta_rad: f64, trust: &TrustConfig) -> Matrix3<f64> {
    icp_information_along(pairs, trust.sigma_m, trust.covariance_scale, theta_rad)
}
