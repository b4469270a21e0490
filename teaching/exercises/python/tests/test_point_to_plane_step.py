"""2. The step across the walls."""

import numpy as np
import rustslam2d as rs
from conftest import assert_same_pose
from point_to_plane_step import point_to_plane_step


def test_a_wall_pulls_across_itself_and_not_along():
    # By hand: points of a wall at x = −1, 0, 1, 0.1 m above it. H = diag(0, 3, 2), so λ = 5e-4/3 + 1e-12, and the step in y is
    # −0.3/(3 + λ).
    src = np.array([[-1.0, 0.1], [0.0, 0.1], [1.0, 0.1]])
    step = point_to_plane_step(src, src + [0.5, -0.1], np.tile([0.0, 1.0], (3, 1)))
    expected = -0.3 / (3.0 + 5e-4 / 3.0 + 1e-12)
    assert abs(step[1] - expected) < 1e-12, f"the step across the wall is {step[1]}, expected {expected}"
    assert abs(step[0]) < 1e-15 and abs(step[2]) < 1e-15, f"the step along the wall and the turn are {step[[0, 2]]}, expected 0"


def corner(off, at):
    """Walls that meet, seen from a pose that is off by `off`: points, partners, normals."""
    along = 0.1 * np.arange(1, 21)
    zero = np.zeros(20)
    walls = [(np.column_stack([along, zero]), [0.0, 1.0]), (np.column_stack([zero, along]), [1.0, 0.0]),
             (np.column_stack([along, zero + 3.0]), [0.0, -1.0])]
    dst = np.vstack([wall for wall, _ in walls])
    normals = np.vstack([np.tile(normal, (20, 1)) for _, normal in walls])
    return rs.transform(off, dst) + at, dst + at, normals


OFF = (0.02, -0.03, 0.01)


def test_a_small_error_is_undone_but_for_the_ridge_and_the_square_of_the_turn():
    left = rs.compose(point_to_plane_step(*corner(OFF, np.zeros(2))), OFF)
    # 5e-4: the ridge is 1e-4 of the mean curvature, and the weakest direction has about a third of it.
    assert_same_pose(left, (0, 0, 0), 5e-4, "what is left of the error")


def test_far_from_the_origin_the_step_is_the_same():
    near = point_to_plane_step(*corner(OFF, np.zeros(2)))
    away = np.array([1000.0, -2000.0])
    far = point_to_plane_step(*corner(OFF, away))
    there = np.append(away, 0.0)
    # Both turn about the centroid of their points; 1e-9: 2000 m have 13 digits left below 1 m.
    assert_same_pose(rs.compose(rs.compose(rs.inverse(there), far), there), near, 1e-9, "the step far from the origin")


def test_it_gives_what_the_core_gives_and_skips_pairs_without_a_normal():
    corners = 0
    for seed in range(20):
        noise = np.random.default_rng(seed)
        _, wall, _ = corner((0, 0, 0), np.zeros(2))
        source = rs.transform(noise.uniform(-0.1, 0.1, 3), wall) + noise.normal(0, 0.02, wall.shape)
        core = rs.icp(source, wall, max_distance=0.4, max_iterations=1, tolerance=0.0)
        paired, partners = rs.icp(source, wall, max_distance=0.4, max_iterations=0).pairs.T
        normals = rs.normals(wall)[partners]
        corners += np.isnan(normals[:, 0]).sum()
        # 1e-9: the core adds terms in a different order.
        assert_same_pose(point_to_plane_step(source[paired], wall[partners], normals), core.trace[1], 1e-9)
    assert corners > 20, "points at the corners have no normal"


def test_two_normals_give_the_identity():
    src, dst, normals = corner((0.1, 0.1, 0.1), np.ones(2))
    normals[2:] = np.nan
    assert_same_pose(point_to_plane_step(src, dst, normals), (0, 0, 0), 1e-15)


def test_three_normals_give_a_step():
    src, dst, normals = corner((0.1, 0.1, 0.1), np.ones(2))
    normals[3:] = np.nan
    step = point_to_plane_step(src, dst, normals)
    assert np.abs(step).max() > 0.05, f"three normals give the step {step}, expected one that is not zero"
