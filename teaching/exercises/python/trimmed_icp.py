"""6. ICP that drops the longest pairs (exercise 6 of the page).

Task. All pairs on a box that was moved between two sweeps are outliers. Write ICP with `trim`, the share of the pairs to
drop, the longest first (Chetverikov et al. 2002). Use svd_align and point_to_plane_step from exercises 1 and 2.

Formula.

    trimmed(pairs): of n pairs keep the k = max(1, ⌈(1 − trim) n⌉) shortest, in their order

    pose = init, pairs = trimmed(associate(source, target, pose, τ))
    repeat at most max_iterations times, while there are min_pairs pairs:
        pose = increment(pairs) · pose        by the variant
        pairs = trimmed(associate(source, target, pose, τ))
        stop if ‖(x, y)‖ + |θ| of the increment is below tolerance; converged if measures_pose(pairs)

associate moves the source by the pose and pairs each point with the nearest target point, if it is closer than
τ = max_distance. With a few hundred points a matrix of all distances is fast enough.

Rules. Pairs exactly as long as the last one kept may also stay. `trace` holds the guess and the pose after each increment;
`inliers` and `rmse` describe the last pairs. The rmse is over the residuals the variant minimizes: distances, or
n · (p − q) for point-to-plane if the pair has a normal. Without pairs it is infinite. `converged` is false unless the
increment was small and given.measures_pose holds for the last pairs: without normals, point-to-plane takes steps of zero,
which say nothing about the pose.

See it drive. rustslam2d.simulate(icp=icp) registers every scan of a lap with it.
"""

import numpy as np
import rustslam2d as rs
from given import Registration, measures_pose
from point_to_plane_step import point_to_plane_step
from svd_align import svd_align


def icp(source, target, init, *, normals=None, variant="point-to-point", max_distance=0.6, max_iterations=25,
        min_pairs=8, tolerance=1e-4, trim=0.0):
    """Registers `source` against `target` from the guess `init`: a Registration.

    source, target: points, shape (n, 2) and (m, 2), m.
    init: guess of target_from_source, shape (3,).
    normals: unit normals of the target, shape (m, 2), NaN where there is none; needed for "point-to-plane".
    """
    raise NotImplementedError("trimmed_icp is not written yet: its task is in trimmed_icp.py")
