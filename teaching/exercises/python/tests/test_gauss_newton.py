"""4. The graph, with a dense matrix."""

import numpy as np
import pytest
import rustslam2d as rs
from conftest import assert_same_pose
from gauss_newton import optimize, optimize_once

OMEGA = np.array([[400.0, 30.0, 5.0], [30.0, 200.0, -8.0], [5.0, -8.0, 900.0]])


def at(x):
    return np.array([x, 0.0, 0.0])


def chi2(poses, edges):
    errors = [(rs.log(rs.between(z, rs.between(poses[i], poses[j]))), omega) for i, j, z, omega in edges]
    return sum(e @ omega @ e for e, omega in errors)


def test_a_loop_error_spreads_evenly_around_the_cycle():
    # The chapter's worked example: χ² falls from 0.36 to 0.12, and each edge takes a third of the error.
    edges = [(0, 1, at(1.0), np.eye(3)), (1, 2, at(1.0), np.eye(3)), (0, 2, at(2.6), np.eye(3))]
    start = np.array([at(0.0), at(1.0), at(2.0)])
    poses, steps = optimize(start, edges, 0, 10, 1e-6, np.inf)
    assert chi2(start, edges) == pytest.approx(0.36), "the given poses must not change"
    # 1e-8: 1e-9 is added to the diagonal.
    assert chi2(poses, edges) == pytest.approx(0.12, abs=1e-8), "the loop's error is not spread evenly"
    assert_same_pose(poses[1], at(1.2), 1e-8, "the second pose")
    assert_same_pose(poses[2], at(2.4), 1e-8, "the third pose")
    assert steps == 2, f"it is linear: one step, and one to confirm convergence; it took {steps}"


def test_a_step_acts_on_the_right():
    # By hand: the node is turned by 90°, and one step brings it to where the edge measured it.
    measured, start = np.array([0.1, 0.0, np.pi / 2]), np.array([[0.0, 0.0, 0.0], [0.0, 0.0, np.pi / 2]])
    found, _ = optimize_once(start, [(0, 1, measured, np.eye(3))], 0, np.inf)
    what = "after a step δ a pose has to be T exp(δ), compose(pose, exp(step)), and not exp(δ) T: the pose"
    assert_same_pose(found[1], measured, 1e-8, what)


def ring(nodes, seed=6):
    """A ring of poses with noise on every edge, and chords across it."""
    rng = np.random.default_rng(seed)
    noisy = lambda pose: rs.compose(pose, rs.exp(rng.normal(0, [0.05, 0.05, 0.03])))
    truth = [np.zeros(3)]
    for _ in range(nodes - 1):
        truth.append(rs.compose(truth[-1], (0.5, 0.02, 0.2)))
    poses = np.array([noisy(pose) for pose in truth])
    chords = [(2 * k, nodes - 1 - k // 2) for k in range(nodes // 3)]
    ends = [(k - 1, k) for k in range(1, nodes)] + chords
    return poses, [(i, j, noisy(rs.between(truth[i], truth[j])), OMEGA) for i, j in ends]


def core_of(poses, edges, fixed, **settings):
    """The core's minimum."""
    graph = rs.PoseGraph()
    for k, pose in enumerate(poses):
        graph.add_node(pose, fixed=k == fixed)
    for edge in edges:
        graph.add_edge(*edge)
    graph.optimize(start="given", tolerance=1e-14, **settings)
    return graph.poses


@pytest.mark.parametrize("fixed", [0, 5])
def test_it_ends_in_the_minimum_of_the_core_whichever_pose_is_held(fixed):
    poses, edges = ring(18)
    found, steps = optimize(poses, edges, fixed, 60, 1e-10, np.inf)
    expected = core_of(poses, edges, fixed)
    assert np.array_equal(found[fixed], poses[fixed]), f"the held pose moved to {found[fixed]}"
    # The chapter's Jacobians lack a factor, so the solver ends near the exact minimum, and χ² tells how near.
    assert chi2(found, edges) < 1.001 * chi2(expected, edges), f"χ² {chi2(found, edges)}, the core has {chi2(expected, edges)}"
    assert steps < 60, "it does not converge"


@pytest.mark.parametrize("huber", [np.inf, 2.0, 0.5])
def test_a_step_solves_the_normal_equations(huber):
    # By another path: numpy's least squares over the stacked, weighted rows of all edges.
    poses, edges = ring(12)
    rows, right, held = [], [], 0
    for i, j, z, omega in edges:
        e = rs.log(rs.between(z, rs.between(poses[i], poses[j])))
        weight = min(1.0, huber / np.sqrt(e @ omega @ e))
        half = np.sqrt(weight) * np.linalg.cholesky(omega).T
        x, y, theta = rs.inverse(z)
        adjoint = [[np.cos(theta), -np.sin(theta), y], [np.sin(theta), np.cos(theta), -x], [0, 0, 1]]
        row = np.zeros((3, 36))
        row[:, 3 * i : 3 * i + 3], row[:, 3 * j : 3 * j + 3] = -half @ adjoint, half
        row[:, 3 * held : 3 * held + 3] = 0
        rows.append(row)
        right.append(-half @ e)
    steps = np.linalg.lstsq(np.vstack(rows), np.concatenate(right), rcond=None)[0].reshape(-1, 3)
    found, largest = optimize_once(poses, edges, held, huber)
    for k, (pose, step) in enumerate(zip(poses, steps)):
        # 1e-8: the ridge of 1e-9 on the diagonal.
        assert_same_pose(found[k], rs.compose(pose, rs.exp(step)), 1e-8, f"pose {k} after a step with huber={huber}")
    expected = np.max(np.hypot(steps[:, 0], steps[:, 1]) + np.abs(steps[:, 2]))
    assert largest == pytest.approx(expected, abs=1e-8), "the largest correction"


def test_a_pose_without_an_edge_stays_by_the_ridge():
    poses, edges = ring(6)
    loose = np.vstack([poses, [9.0, 9.0, 0.0]])
    found, largest = optimize_once(loose, edges, 0, np.inf)
    assert np.isfinite(largest), "1e-9 on the diagonal keeps the matrix positive definite"
    assert_same_pose(found[-1], loose[-1], 1e-9, "the pose without an edge")


def test_a_matrix_that_is_not_positive_definite_moves_nothing():
    poses, edges = ring(6)
    wrong = [*edges, (0, 3, at(1.0), -1e4 * np.eye(3))]
    found, largest = optimize_once(poses, wrong, 0, np.inf)
    assert np.isnan(largest), f"the largest correction is {largest}, expected NaN"
    assert np.array_equal(found, poses), "no pose moves"
    assert optimize(poses, wrong, 0, 10, 1e-9, np.inf)[1] == 1, "NaN ends it"


def test_the_kernel_counts_in_every_step():
    poses, edges = ring(12)
    expected = poses
    for _ in range(3):
        expected, _ = optimize_once(expected, edges, 0, 0.5)
    found, _ = optimize(poses, edges, 0, 3, 1e-15, 0.5)
    assert np.array_equal(found, expected), "three steps with a kernel are not those of optimize_once"


def test_it_takes_no_more_steps_than_it_may():
    poses, edges = ring(18)
    once, _ = optimize_once(poses, edges, 0, np.inf)
    found, steps = optimize(poses, edges, 0, 1, 1e-12, np.inf)
    assert steps == 1 and np.array_equal(found, once), f"{steps} steps, but one was allowed"
    assert optimize(poses, edges, 0, 50, 1e3, np.inf)[1] == 1, "a correction below the tolerance ends it"
