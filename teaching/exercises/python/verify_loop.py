"""5. The verification of a loop candidate.

Task. A detector proposes that `node` revisits `candidate`. Register the sweep of `node` against the submap around
`candidate`, and accept the loop if both tests pass: it fits, and its innovation is within the drift of the odometry.

Formula. The registration starts at the pose predicted by the graph, and the gate tests against that:

    T₀ = T_candidate⁻¹ T_node        T̂ = icp(sweep, submap, T₀)
    ξ = log(T₀⁻¹ T̂)
    S = gap · diag(σ², σ², σ_θ²)        gap = node − candidate, (σ, σ_θ) = config.drift
    χ² = ξᵀ S⁻¹ ξ
    accepted if rmse ≤ config.max_rmse, inliers ≥ max(config.min_inliers, 8), and χ² ≤ config.gate

The edge measures T̂. Its information is regularize(icp_information(p, normals, σ, inflate), 1.0, 2500.0) with
(σ, inflate) = config.trust, the paired points p of the sweep moved by T̂, and the normals of their matches. Note that
this is the chapter's matrix, about the centroid of the pairs and in the candidate's axes. An exact edge would take it
about the robot, in the axes of `node`.

Rules. ICP is point-to-point, τ = max(config.radius / 2, 0.6), at most 30 iterations: rustslam2d.icp with
variant="point-to-point", max_distance=τ and max_iterations=30. Its result has pose, rmse, inliers, and pairs, the indices of
the paired points in the sweep and the submap. With fewer than 8 pairs it returns its guess, which is no
measurement.

`given` has the rest: submap(poses, sweeps, center, config) returns points and normals; icp_information; regularize; LoopConfig.
"""

import numpy as np
import rustslam2d as rs
from given import LoopConfig, VerifiedLoop, icp_information, regularize, submap


def verify_loop(poses, sweeps, node, candidate, config=LoopConfig()):
    """Registers the sweep of `node` against the submap around `candidate`, and tests the result: a VerifiedLoop.

    poses: of all nodes in the graph, shape (k, 3).
    sweeps: sweeps[k] holds the points of node k in its own frame, shape (n, 2), m.
    """
    raise NotImplementedError("verify_loop is not written yet: its task is in verify_loop.py")
