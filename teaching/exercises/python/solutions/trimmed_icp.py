"""6. ICP that drops the longest pairs."""

import numpy as np
import rustslam2d as rs
from given import Registration, measures_pose
from point_to_plane_step import point_to_plane_step
from svd_align import svd_align


def associate(source, target, pose, tau, trim):
    """The pairs at a pose: moved points, and the numbers of their partners."""
    moved = rs.transform(pose, source)
    squares = np.sum((moved[:, None] - target[None]) ** 2, axis=2)
    nearest = np.argmin(squares, axis=1)
    lengths = squares[np.arange(len(moved)), nearest]
    paired = lengths < tau**2
    moved, nearest, lengths = moved[paired], nearest[paired], lengths[paired]
    if trim > 0 and len(lengths) > 0:
        kept = max(1, int(np.ceil((1 - trim) * len(lengths))))
        short = lengths <= np.sort(lengths)[kept - 1]
        moved, nearest = moved[short], nearest[short]
    return moved, nearest


def icp(source, target, init, *, normals=None, variant="point-to-point", max_distance=0.6, max_iterations=25,
        min_pairs=8, tolerance=1e-4, trim=0.0):
    """Registers `source` against `target` from the guess `init`."""
    is_plane = variant == "point-to-plane"
    pose = np.array(init, dtype=float)
    trace = [pose]
    converged = False
    moved, nearest = associate(source, target, pose, max_distance, trim)
    while len(trace) <= max_iterations and len(moved) >= min_pairs:
        if is_plane:
            step = point_to_plane_step(moved, target[nearest], normals[nearest])
        else:
            step = svd_align(moved, target[nearest])
        pose = rs.compose(step, pose)
        trace.append(pose)
        moved, nearest = associate(source, target, pose, max_distance, trim)
        if np.hypot(step[0], step[1]) + abs(step[2]) < tolerance:
            known = normals[nearest] if is_plane else None
            converged = measures_pose(moved, known, variant, min_pairs)
            break
    errors = np.linalg.norm(moved - target[nearest], axis=1)
    if is_plane:
        along = np.sum(normals[nearest] * (moved - target[nearest]), axis=1)
        errors = np.where(np.isnan(along), errors, along)
    rmse = np.sqrt(np.mean(errors**2)) if len(errors) > 0 else np.inf
    return Registration(pose, rmse, len(errors), np.array(trace), converged)
