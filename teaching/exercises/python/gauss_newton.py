"""4. Gauss–Newton on a pose graph, with a dense matrix.

Task. Move all poses except the fixed one to minimize the weighted sum of squared residuals. Use residual and jacobians from
exercise 3.

Formula. For n poses H is 3n × 3n. Every edge (i, j) adds, with its Ω, its e and its Jacobians Jᵢ, Jⱼ,

    w = min(1, huber / m)        m = √(eᵀ Ω e)
    H[a, b] += Jₐᵀ w Ω J_b        g[a] += Jₐᵀ w Ω e        a, b ∈ {i, j}

Rows and columns of the fixed pose are zero except for a unit diagonal, and 1e-9 is added to the whole diagonal. Solve
H x = −g by Cholesky (numpy.linalg.cholesky raises LinAlgError if H is not positive definite), and move every pose:
T ← T exp(x). rustslam2d.exp(x) is exp.

Shapes. poses (n, 3). An edge is a tuple (i, j, z, omega): z of shape (3,) measures pose j in the frame of pose i, omega of
shape (3, 3) is the inverse covariance of its residual.
"""

import numpy as np
import rustslam2d as rs
from residual import jacobians, residual


def optimize_once(poses, edges, fixed=0, huber=np.inf):
    """One step: (the new poses, the largest correction of a pose, ‖(v_x, v_y)‖ + |ω|).

    If the matrix is not positive definite it returns the old poses and NaN. The argument `poses` stays as it is.
    """
    raise NotImplementedError("gauss_newton is not written yet: its task is in gauss_newton.py")


def optimize(poses, edges, fixed=0, max_iters=20, tolerance=1e-6, huber=np.inf):
    """Steps until the largest correction is below `tolerance` or NaN, at most `max_iters`: (poses, steps)."""
    raise NotImplementedError("gauss_newton is not written yet: its task is in gauss_newton.py")
