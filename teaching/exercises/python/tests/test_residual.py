"""3. The residual of an edge and its Jacobians."""

import numpy as np
import rustslam2d as rs
from residual import jacobians, residual


def random_poses(seed, count):
    return np.random.default_rng(seed).uniform(-3, 3, (count, 3))


def assert_near(found, expected, tolerance, what):
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape, f"{what} must have the shape {expected.shape}, not {found.shape}"
    assert np.abs(found - expected).max() < tolerance, f"{what} is\n{found}, expected\n{expected}"


def test_a_loop_that_says_more_than_the_poses_has_a_negative_error():
    # The chapter's worked example: 2 m by the poses, 2.6 m by the loop.
    e = residual(np.zeros(3), np.array([2.0, 0, 0]), np.array([2.6, 0, 0]))
    assert_near(e, [-0.6, 0, 0], 1e-12, "the error")


def test_the_error_is_the_logarithm():
    # By hand: a quarter of a circle of radius 1 ends at (1, 1), turned by 90°; followed for unit time it is (π/2, 0, π/2).
    e = residual(np.zeros(3), np.array([1.0, 1.0, np.pi / 2]), np.zeros(3))
    assert_near(e, [np.pi / 2, 0, np.pi / 2], 1e-12, "the error of a quarter turn")


def test_it_is_zero_if_the_poses_say_what_was_measured_and_depends_on_their_relation_alone():
    for from_, z, world, to in random_poses(7, 200).reshape(-1, 4, 3):
        as_measured = residual(from_, rs.compose(from_, z), z)
        assert_near(as_measured, np.zeros(3), 1e-12, "if Tⱼ = Tᵢ Z, the error log(Z⁻¹ Tᵢ⁻¹ Tⱼ), its factors in this order,")
        here, there = residual(from_, to, z), residual(rs.compose(world, from_), rs.compose(world, to), z)
        # Turned by almost π a logarithm may jump to −π.
        apart = rs.between(rs.exp(here), rs.exp(there))
        assert np.abs(apart).max() < 1e-9, f"the error is {here}, and {there} after both poses moved together by {world}"


def test_the_jacobians_of_a_quarter_turn():
    # By hand: Z = (1, 2, 90°) has the inverse (−2, 1, −90°).
    at_from, at_to = jacobians(np.array([1.0, 2.0, np.pi / 2]))
    assert_near(at_from, [[0, -1, -1], [1, 0, -2], [0, 0, -1]], 1e-12, "the Jacobian of node i")
    assert_near(at_to, np.eye(3), 1e-12, "the Jacobian of node j")


def test_if_the_error_is_zero_the_jacobians_are_the_derivatives():
    small = 1e-6
    for from_, z in random_poses(8, 100).reshape(-1, 2, 3):
        to = rs.compose(from_, z)
        at_from, at_to = jacobians(z)
        for k, step in enumerate(small * np.eye(3)):
            by_from = residual(rs.compose(from_, rs.exp(step)), to, z) / small
            by_to = residual(from_, rs.compose(to, rs.exp(step)), z) / small
            # 1e-4: one-sided differences, with arms of up to 4 m.
            assert_near(at_from[:, k], by_from, 1e-4, f"column {k} of the Jacobian of node i")
            assert_near(at_to[:, k], by_to, 1e-4, f"column {k} of the Jacobian of node j")
