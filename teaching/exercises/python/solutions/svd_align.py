"""1. The best rigid motion for given pairs."""

import numpy as np


def svd_align(src, dst):
    """The motion (x, y, θ) that minimizes Σ ‖R p + t − q‖²."""
    if len(src) == 0:
        return np.zeros(3)
    p_mean, q_mean = np.mean(src, axis=0), np.mean(dst, axis=0)
    h = (src - p_mean).T @ (dst - q_mean)
    u, _, v_t = np.linalg.svd(h)
    sign = np.sign(np.linalg.det(v_t.T @ u.T))
    r = v_t.T @ np.diag([1.0, sign]) @ u.T
    return np.append(q_mean - r @ p_mean, np.arctan2(r[1, 0], r[0, 0]))
