//! 5. The verification of a loop candidate.
//!
//! **Task.** A detector proposes that `node` revisits `candidate`. Register the sweep of `node` against the submap
//! around `candidate`, and accept the loop if both tests pass: it fits, and its innovation is within the drift of the
//! odometry.
//!
//! **Formula.** The registration starts at the pose predicted by the graph, and the gate tests against that:
//!
//! ```text
//! T₀ = T_candidate⁻¹ T_node        T̂ = icp(sweep, submap, T₀)
//! ξ = log(T₀⁻¹ T̂)
//! S = gap · diag(σ², σ², σ_θ²)        gap = node − candidate, (σ, σ_θ) = cfg.drift
//! χ² = ξᵀ S⁻¹ ξ
//! accepted if rmse ≤ cfg.max_rmse, inliers ≥ max(cfg.min_inliers, min_pairs), and χ² ≤ cfg.gate
//! ```
//!
//! The edge measures T̂. Its information is `regularize(icp_information(pairs, σ, inflate), 1.0, 2500.0)` for the
//! pairs from `associate` at T̂ and `(σ, inflate) = cfg.trust`. This is the chapter's matrix, about the centroid of
//! the pairs and in the candidate's axes. An exact edge would take it about the robot, in the axes of `node`.
//!
//! **Rules.** ICP is point-to-point, τ = max(cfg.radius/2, 0.6), at most 30 iterations, otherwise the default. With
//! fewer pairs than its `min_pairs` it returns its guess, which is no measurement. The
//! listings provide the rest: `submap`, `icp`, `associate`, `icp_information`, `regularize`.

use ch16_listings::{LoopConfig, PointCloud, PoseGraph, VerifiedLoop};
use petgraph::graph::NodeIndex;

/// Registers the sweep of `node` against the submap around `candidate`, and tests the result.
///
/// `sweeps[k]` is the sweep of node k in its own frame.
#[must_use]
pub fn verify_loop(
    graph: &PoseGraph,
    sweeps: &[PointCloud],
    node: NodeIndex,
    candidate: NodeIndex,
    cfg: &LoopConfig,
) -> VerifiedLoop {
    crate::not_written("verify_loop")
}
