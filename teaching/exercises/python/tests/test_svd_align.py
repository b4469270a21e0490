"""1. The closed form."""

import numpy as np
import rustslam2d as rs
from conftest import assert_same_pose
from svd_align import svd_align


def random_pairs(seed):
    """Twelve random pairs: no motion fits them well."""
    return np.random.default_rng(seed).uniform(-3, 3, (2, 12, 2))


def test_four_points_on_the_unit_circle_give_the_motion_that_moved_them():
    # The chapter's worked example: the rotation of the 3-4-5 triangle, multiplied out by hand, and t = (2, 1).
    src = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    dst = np.array([[2.8, 1.6], [1.4, 1.8], [1.2, 0.4], [2.6, 0.2]])
    assert_same_pose(svd_align(src, dst), (2.0, 1.0, np.arctan2(0.6, 0.8)), 1e-12)


def test_no_motion_nearby_costs_less():
    for seed in range(20):
        src, dst = random_pairs(seed)
        cost = lambda pose: np.sum((rs.transform(pose, src) - dst) ** 2)
        found = svd_align(src, dst)
        for direction in np.eye(3):
            for step in (-1.0, -1e-3, 1e-3, 1.0, 2.0, 3.0):
                moved = rs.compose(found, rs.exp(step * direction))
                assert cost(moved) > cost(found), f"{step} along {direction} costs {cost(moved)}, not {cost(found)}"


def test_mirrored_points_give_the_best_rotation():
    # By hand: Σ cross = −Σ 2 x y and Σ dot = Σ (x² − y²) of points that are centred.
    src = np.array([[2.0, 0.1], [-2.0, -0.1], [0.3, 1.0], [-0.3, -1.0]])
    x, y = src.T
    expected = (0.0, 0.0, np.arctan2(-2 * np.sum(x * y), np.sum(x**2 - y**2)))
    found = svd_align(src, src * [1, -1])
    assert_same_pose(found, expected, 1e-12, "without the determinant the result is a reflection: the pose")


def test_it_gives_what_the_core_gives():
    for seed in range(20, 40):
        source = np.random.default_rng(seed).uniform(-3, 3, (12, 2))
        target = np.random.default_rng(seed + 100).uniform(-3, 3, (40, 2))
        core = rs.icp(source, target, variant="point-to-point", max_distance=9.0, max_iterations=1, tolerance=0.0)
        first = rs.icp(source, target, variant="point-to-point", max_distance=9.0, max_iterations=0)
        paired, partners = first.pairs.T
        assert_same_pose(svd_align(source[paired], target[partners]), core.trace[1], 1e-9)


def test_no_pairs_give_the_identity():
    assert_same_pose(svd_align(np.zeros((0, 2)), np.zeros((0, 2))), (0, 0, 0), 1e-15)


def test_coincident_points_are_carried_onto_their_partners():
    # Every rotation about the place fits as well, but none moves it elsewhere.
    here, there = np.array([1.3, -0.7]), np.array([-0.4, 2.1])
    for count in (1, 2, 9):
        found = svd_align(np.tile(here, (count, 1)), np.tile(there, (count, 1)))
        off = np.linalg.norm(rs.transform(found, here[None])[0] - there)
        assert off < 1e-12 and np.isfinite(found[2]), f"{count} coincident points end {off:.2e} m off: {found}"
