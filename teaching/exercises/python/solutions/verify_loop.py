"""5. The verification of a loop candidate."""

import numpy as np
import rustslam2d as rs
from given import LoopConfig, VerifiedLoop, icp_information, regularize, submap


def verify_loop(poses, sweeps, node, candidate, config=LoopConfig()):
    """Registers the sweep of `node` against the submap around `candidate`, and tests the result."""
    points, normals = submap(poses, sweeps, candidate, config)
    belief = rs.between(poses[candidate], poses[node])
    tau = max(config.radius / 2, 0.6)
    found = rs.icp(
        sweeps[node], points, init=belief, variant="point-to-point", max_distance=tau, max_iterations=30
    )
    innovation = rs.log(rs.between(belief, found.pose))
    xy, theta = config.drift
    variances = (node - candidate) * np.array([xy**2, xy**2, theta**2])
    chi2 = np.sum(innovation**2 / variances)
    paired, partners = found.pairs.T
    moved = rs.transform(found.pose, sweeps[node][paired])
    information = icp_information(moved, normals[partners], *config.trust)
    # With fewer pairs icp returns its guess.
    fits = found.rmse <= config.max_rmse and found.inliers >= max(config.min_inliers, 8)
    return VerifiedLoop(
        pose=found.pose,
        information=regularize(information, 1.0, 2500.0),
        rmse=found.rmse,
        inliers=found.inliers,
        chi2=chi2,
        accepted=bool(fits and chi2 <= config.gate),
    )
