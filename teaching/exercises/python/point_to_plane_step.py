"""2. One Gauss–Newton step on the distances along the normals.

Task. A point of the sweep may slide along its match's wall; only the distance across the wall counts:

    Σ (nₖ · (pₖ − qₖ))²        over the pairs that have a normal

Formula (Chen & Medioni 1992). Let c be the centroid of the points pₖ of these pairs, eₖ = nₖ · (pₖ − qₖ). A small motion
(tₓ, t_y, θ), which turns about c and then shifts, changes eₖ by Jₖ · (tₓ, t_y, θ) with

    Jₖ = (nₓ, n_y, (pₖ − c) × n)        a × b = aₓ b_y − a_y bₓ
    H = Σ Jₖᵀ Jₖ        g = Σ Jₖᵀ eₖ        (H + λ I) x = −g
    λ = 1e-4 · tr(H)/3 + 1e-12

The ridge λ allows no step in a direction that no normal sees. The returned motion turns about c, not about the origin:
T(tₓ, t_y) · T(c) · R(θ) · T(c)⁻¹. rustslam2d.compose(a, b) is a · b, rustslam2d.inverse(a) is a⁻¹.

Rules. Pairs without a normal do not count: their row of `normals` is NaN. Fewer than three normals give the identity.
"""

import numpy as np
import rustslam2d as rs


def point_to_plane_step(src, dst, normals):
    """The step (x, y, θ), a motion in the frame of the map, shape (3,): the new pose is compose(step, pose).

    src: points of the sweep, moved by the present pose, shape (n, 2), m.
    dst: their matches in the map, shape (n, 2), m.
    normals: unit normals of the matches, shape (n, 2).
    """
    raise NotImplementedError("point_to_plane_step is not written yet: its task is in point_to_plane_step.py")
