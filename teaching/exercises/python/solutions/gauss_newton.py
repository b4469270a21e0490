"""4. Gauss–Newton on a pose graph, with a dense matrix."""

import numpy as np
import rustslam2d as rs
from residual import jacobians, residual


def optimize_once(poses, edges, fixed=0, huber=np.inf):
    """One step: the new poses and the largest correction."""
    poses = np.array(poses, dtype=float)
    size = 3 * len(poses)
    h, g = 1e-9 * np.eye(size), np.zeros(size)
    for i, j, z, omega in edges:
        e = residual(poses[i], poses[j], z)
        m = np.sqrt(max(e @ omega @ e, 0.0))
        weighted = omega * (huber / m if m > huber else 1.0)
        at_i, at_j = jacobians(z)
        free = [(k, at) for k, at in ((i, at_i), (j, at_j)) if k != fixed]
        for row, left in free:
            g[3 * row : 3 * row + 3] += left.T @ weighted @ e
            for column, right in free:
                h[3 * row : 3 * row + 3, 3 * column : 3 * column + 3] += left.T @ weighted @ right
    for k in range(3 * fixed, 3 * fixed + 3):
        h[k, k] += 1.0
    try:
        lower = np.linalg.cholesky(h)
    except np.linalg.LinAlgError:
        return poses, np.nan
    steps = np.linalg.solve(lower.T, np.linalg.solve(lower, -g)).reshape(-1, 3)
    moved = np.array([rs.compose(pose, rs.exp(step)) for pose, step in zip(poses, steps)])
    return moved, np.max(np.hypot(steps[:, 0], steps[:, 1]) + np.abs(steps[:, 2]))


def optimize(poses, edges, fixed=0, max_iters=20, tolerance=1e-6, huber=np.inf):
    """Steps until the largest correction is small."""
    for step in range(1, max_iters + 1):
        poses, largest = optimize_once(poses, edges, fixed, huber)
        if np.isnan(largest) or largest < tolerance:
            return poses, step
    return poses, max_iters
