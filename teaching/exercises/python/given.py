"""What the exercises are given: the submap around a keyframe, the information of pairs, and the types of results."""

from typing import Any, NamedTuple

import numpy as np
import rustslam2d as rs


class LoopConfig(NamedTuple):
    """The constants of loop closure."""

    #: Candidates are within this distance in the graph, m.
    radius: float = 2.0
    #: The submap holds this many nodes on either side of the candidate.
    half_width: int = 3
    #: First test: largest accepted error of the fit, m, and smallest number of pairs.
    max_rmse: float = 0.16
    min_inliers: int = 25
    #: Second test: drift per node, standard deviations, m and rad; it grows with √gap.
    drift: tuple = (0.045, 0.012)
    #: Second test: largest accepted squared innovation, the 95% quantile of χ² with three degrees of freedom.
    gate: float = rs.chi2_gate(0.95)
    #: Noise of a point, m, and the covariance scale for correlated beams.
    trust: tuple = (0.05, 25.0)


class VerifiedLoop(NamedTuple):
    """Result of the registration and of the tests of a loop."""

    #: The measured pose of the new node in the frame of the candidate, shape (3,).
    pose: Any
    #: Inverse covariance of that measurement, shape (3, 3).
    information: Any
    #: Root mean square distance of the pairs, m.
    rmse: float
    #: Number of the pairs.
    inliers: int
    #: The squared innovation in units of the drift.
    chi2: float
    #: Whether both tests passed.
    accepted: bool


class Registration(NamedTuple):
    """Result of the ICP of exercise 6."""

    #: target_from_source, shape (3,).
    pose: Any
    #: Root mean square residual of the last pairs, m; infinite without pairs.
    rmse: float
    #: Number of the last pairs.
    inliers: int
    #: The initial guess and the pose after each increment, shape (iterations + 1, 3).
    trace: Any
    #: Whether an increment below the tolerance ended it, and the last pairs measure the pose.
    converged: bool = False


#: Side of a cell of the submap, m, and the most points per cell.
SUBMAP_CELL, SUBMAP_MOST = 0.25, 6


def submap(poses, sweeps, center, config=LoopConfig()):
    """The sweeps around a node at their poses, in the frame of that node: points and unit normals, shape (n, 2) each.

    A cell keeps its first points. A normal is NaN where there is none.
    """
    first, last = max(center - config.half_width, 0), min(center + config.half_width, len(poses) - 1)
    center_from_world = rs.inverse(poses[center])
    count, points, normals = {}, [], []
    for near in range(first, last + 1):
        pose = poses[near]
        turn = pose[2] + center_from_world[2]
        rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        moved = rs.transform(center_from_world, rs.transform(pose, sweeps[near]))
        for point, normal in zip(moved, rs.normals(sweeps[near]) @ rotation.T):
            cell = tuple(np.floor(point / SUBMAP_CELL))
            count[cell] = count.get(cell, 0) + 1
            if count[cell] <= SUBMAP_MOST:
                points.append(point)
                normals.append(normal)
    return np.array(points), np.array(normals)


def icp_information(points, normals, sigma, inflate):
    """Σ J Jᵀ / (σ² · inflate), shape (3, 3): a row J = (n, (p − c) × n) for each direction that a pair measures.

    points: the paired points in the frame of the map, shape (n, 2); c is their centroid.
    normals: of the matches; a pair without a normal measures both axes.
    sigma: noise of a point, m. inflate: neighbouring beams are not independent.
    """
    if len(points) == 0:
        return np.zeros((3, 3))
    arms = points - points.mean(axis=0)
    known = ~np.isnan(normals[:, 0])
    axes = [np.tile(axis, (np.sum(~known), 1)) for axis in ([1.0, 0.0], [0.0, 1.0])]
    directions = np.vstack([normals[known], *axes])
    arms = np.vstack([arms[known], arms[~known], arms[~known]])
    cross = arms[:, 0] * directions[:, 1] - arms[:, 1] * directions[:, 0]
    rows = np.column_stack([directions, cross])
    return rows.T @ rows / (sigma**2 * inflate)


def measures_pose(points, normals, variant, min_pairs):
    """Whether pairs measure a pose: there are enough, and every direction is constrained, unlike along a corridor.

    points: the paired points in the frame of the map, shape (n, 2).
    normals: of their partners, NaN where there is none; only "point-to-plane" reads them. It uses the pairs that have one,
    and needs twice as many, because each measures one number, not two.
    """
    needed, ridge = max(min_pairs, 1), 1e-12
    if variant == "point-to-plane":
        known = ~np.isnan(normals[:, 0])
        points, normals = points[known], normals[known]
        needed, ridge = max(2 * min_pairs, 3), 1e-4 / 3
    else:
        normals = np.full_like(points, np.nan)
    information = icp_information(points, normals, 1.0, 1.0)
    return len(points) >= needed and bool(np.linalg.eigvalsh(information)[0] > ridge * np.trace(information))


def regularize(omega, ridge, cap):
    """The information with `ridge` on its diagonal, scaled so that no diagonal entry exceeds `cap`."""
    ridged = omega + ridge * np.eye(3)
    return ridged * min(1.0, cap / np.max(np.diag(ridged)))
