"""2. One Gauss–Newton step on the distances along the normals."""

import numpy as np
import rustslam2d as rs


def point_to_plane_step(src, dst, normals):
    """The step (x, y, θ), a motion in the frame of the map."""
    known = ~np.isnan(normals[:, 0])
    if known.sum() < 3:
        return np.zeros(3)
    p, q, n = src[known], dst[known], normals[known]
    c = p.mean(axis=0)
    e = np.sum(n * (p - q), axis=1)
    arm = (p - c)[:, 0] * n[:, 1] - (p - c)[:, 1] * n[:, 0]
    j = np.column_stack([n, arm])
    h = j.T @ j
    h += (1e-4 * np.trace(h) / 3 + 1e-12) * np.eye(3)
    x, y, theta = np.linalg.solve(h, -j.T @ e)
    center = np.append(c, 0.0)
    about = rs.compose(rs.compose(center, (0.0, 0.0, theta)), rs.inverse(center))
    return rs.compose((x, y, 0.0), about)
