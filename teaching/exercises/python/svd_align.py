"""1. The best rigid motion for given pairs.

Task. src[k] and dst[k] are the same point in two frames, with noise. Find the motion (R, t) that minimizes

    Σ ‖R pₖ + t − qₖ‖²

Formula (Arun, Huang, Blostein 1987; Umeyama 1991). With the means p̄ and q̄

    W = Σ (pₖ − p̄)(qₖ − q̄)ᵀ = U D Vᵀ
    R = V diag(1, det(V Uᵀ)) Uᵀ        t = q̄ − R p̄

The determinant turns a reflection into the best rotation. numpy.linalg.svd returns U, the singular values and Vᵀ. In the
plane you may instead solve for the angle: arctan2 of a sum of cross products and a sum of dot products.

Rules. Without pairs, return the identity.
"""

import numpy as np


def svd_align(src, dst):
    """The motion (x, y, θ) that minimizes Σ ‖R p + t − q‖², shape (3,).

    src, dst: shape (n, 2), m.
    """
    raise NotImplementedError("svd_align is not written yet: its task is in svd_align.py")
