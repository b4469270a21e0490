//! 6. ICP that drops the longest pairs (exercise 6 of the page).
//!
//! **Task.** All pairs on a box that was moved between two sweeps are outliers. Write ICP with
//! `cfg.trim`, the share of the pairs to drop, the longest first (Chetverikov et al. 2002). Use `crate::svd_align` and
//! `crate::point_to_plane_step` from exercises 1 and 2.
//!
//! **Formula.**
//!
//! ```text
//! trimmed(pairs): of n pairs keep the k = max(1, ⌈(1 − trim) n⌉) shortest, in their order
//!
//! pose = init, pairs = trimmed(associate(cloud, map, pose, τ))
//! repeat at most max_iters times, while there are min_pairs pairs:
//!     pose = increment(pairs) · pose        by cfg.variant
//!     pairs = trimmed(associate(cloud, map, pose, τ))
//!     stop if increment.step_size() < tolerance; converged if measures_pose(pairs, cfg)
//! ```
//!
//! **Rules.** Pairs exactly as long as the last one kept may also stay. `trace` holds the guess and the pose after each
//! increment; `inliers` and `rmse` describe the last pairs. The rmse is over the residuals the variant minimizes: distances, or
//! `n · (p − q)` for point-to-plane if the pair has a normal. Without pairs it is infinite. `converged` is false unless the
//! increment was small and `ch16_listings::measures_pose` holds for the last pairs: without normals, point-to-plane takes
//! steps of zero, which say nothing about the pose.

use ch16_listings::{IcpConfig, IcpResult, PointCloud, SE2, VoxelMap};

/// Registers a cloud against a map from the guess `init`.
#[must_use]
pub fn icp(cloud: &PointCloud, map: &VoxelMap, init: SE2, cfg: &IcpConfig) -> IcpResult {
    crate::not_written("trimmed_icp")
}
