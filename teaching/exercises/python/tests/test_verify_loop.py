"""5. The gate, on the canonical lap."""

import numpy as np
import pytest
import rustslam2d as rs
from conftest import assert_same_pose
from given import LoopConfig, icp_information, regularize, submap
from verify_loop import verify_loop

#: An offset of the belief from which registration is slow.
SLOW = (-0.2, 0.6, 0.1)

#: The first loop of the lap.
NODE, OLD = 29, 7


@pytest.fixture(scope="module")
def first(lap):
    poses, sweeps = lap
    return poses[: NODE + 1], sweeps[: NODE + 1]


def register(first, config, tau, limit):
    """The core's registration from the belief."""
    poses, sweeps = first
    points, _ = submap(poses, sweeps, OLD, config)
    belief = rs.between(poses[OLD], poses[NODE])
    return rs.icp(sweeps[NODE], points, init=belief, variant="point-to-point", max_distance=tau, max_iterations=limit)


def moved(first, by):
    """The same with the node's belief moved."""
    poses, sweeps = first
    return np.vstack([poses[:NODE], rs.compose(poses[NODE], by)]), sweeps


def test_the_three_loops_of_the_lap_have_the_numbers_of_the_reference():
    # tests/reference/lap.json, computed by an independent implementation.
    reference = [(29, 7, 4.235831, 0.134182, 87), (33, 6, 0.420640, 0.061404, 78), (37, 2, 1.125345, 0.071445, 93)]
    found = []

    def gate(poses, sweeps, node, candidate):
        loop = verify_loop(poses, sweeps, node, candidate)
        found.append((node, candidate, loop))
        return loop

    rs.simulate(gate=gate)
    assert [(node, old) for node, old, _ in found[:3]] == [(node, old) for node, old, *_ in reference]
    for (node, old, loop), (_, _, chi2, rmse, inliers) in zip(found, reference):
        what = f"loop {node} to {old}"
        # 1e-5: the digits above; rounding accumulates over a lap.
        assert loop.inliers == inliers, f"{what} has {loop.inliers} pairs, expected {inliers}"
        assert loop.rmse == pytest.approx(rmse, abs=1e-5), f"{what}: the rmse"
        assert loop.chi2 == pytest.approx(chi2, abs=1e-5), f"{what}: χ²"
        assert loop.accepted, f"{what} passes both tests but is rejected"


def test_a_belief_that_is_far_off_fails_the_gate_and_nothing_else(first):
    right, off = verify_loop(*first, NODE, OLD), verify_loop(*moved(first, (0, 0, 0.2)), NODE, OLD)
    assert off.rmse <= 0.16 and off.inliers >= 25, f"it fits, because registration corrects the rotation: {off}"
    assert off.chi2 > 7.815 and not off.accepted, f"χ² {off.chi2} is above 7.815, but accepted is {off.accepted}"
    assert abs(rs.between(right.pose, off.pose)[2]) < 0.02, "the edge is what was registered"


def test_the_drift_grows_with_the_gap(first):
    poses, _ = first
    usual = verify_loop(*first, NODE, OLD)
    innovation = rs.log(rs.between(rs.between(poses[OLD], poses[NODE]), usual.pose))
    # By hand: 22 nodes of 0.045 m and 0.012 rad each.
    expected = np.sum(innovation**2 / (22 * np.array([0.045**2, 0.045**2, 0.012**2])))
    assert usual.chi2 == pytest.approx(expected, abs=1e-9), "χ²"
    narrow = verify_loop(*first, NODE, OLD, LoopConfig(drift=(0.0225, 0.006)))
    assert narrow.chi2 == pytest.approx(4 * usual.chi2, abs=1e-9), "χ² at half the drift"
    assert not narrow.accepted


def test_a_poor_fit_and_few_pairs_fail_whatever_the_gate_says(first):
    usual = verify_loop(*first, NODE, OLD)
    for config in (LoopConfig(max_rmse=0.99 * usual.rmse), LoopConfig(min_inliers=usual.inliers + 1)):
        found = verify_loop(*first, NODE, OLD, config)
        assert found.chi2 <= config.gate and not found.accepted, f"{found} is accepted by {config}"
    limits = LoopConfig(max_rmse=usual.rmse, min_inliers=usual.inliers, gate=usual.chi2)
    assert verify_loop(*first, NODE, OLD, limits).accepted, "≤ and ≥, not < and >"


def test_the_gate_is_the_one_that_was_asked_for(first):
    usual = verify_loop(*first, NODE, OLD)
    narrow = verify_loop(*first, NODE, OLD, LoopConfig(gate=0.99 * usual.chi2))
    assert not narrow.accepted, f"χ² {narrow.chi2} is above the gate {0.99 * usual.chi2}, but the loop is accepted"
    wide = verify_loop(*moved(first, (0, 0, 0.2)), NODE, OLD, LoopConfig(gate=1e6))
    assert wide.accepted, f"χ² {wide.chi2} is below the gate 1e6, but the loop is rejected"


def test_a_narrow_search_still_pairs_within_0_6_m_and_a_wide_one_within_half_its_radius(first):
    off = moved(first, (0.3, -0.2, 0.05))
    for radius, half_width, tau in ((0.4, 3, 0.6), (1.0, 1, 0.6), (3.0, 3, 1.5)):
        config = LoopConfig(radius=radius, half_width=half_width)
        found, expected = verify_loop(*off, NODE, OLD, config), register(off, config, tau, 30)
        assert found.inliers == expected.inliers, f"{found.inliers} pairs at radius {radius} m, expected {expected.inliers}"
        assert_same_pose(found.pose, expected.pose, 1e-9)


def test_the_registration_may_take_30_iterations(first):
    # From this belief 25 iterations, the default, do not reach the end.
    slow = moved(first, SLOW)
    early, expected = (register(slow, LoopConfig(), 1.0, limit) for limit in (25, 30))
    assert np.abs(early.pose - expected.pose).max() > 0.01
    assert_same_pose(verify_loop(*slow, NODE, OLD).pose, expected.pose, 1e-9)


def test_the_edge_knows_what_its_pairs_know_and_trusts_its_points_as_it_is_told(first):
    poses, sweeps = first
    points, normals = submap(poses, sweeps, OLD)
    found = register(first, LoopConfig(), 1.0, 30)
    paired, partners = found.pairs.T
    at = rs.transform(found.pose, sweeps[NODE][paired])
    for trust in ((0.05, 25.0), (0.1, 25.0), (0.05, 50.0), (0.01, 1.0)):
        expected = regularize(icp_information(at, normals[partners], *trust), 1.0, 2500.0)
        omega = verify_loop(*first, NODE, OLD, LoopConfig(trust=trust)).information
        assert np.abs(omega - expected).max() < 1e-6, f"with trust={trust} the information is\n{omega}, expected\n{expected}"


def test_a_guess_without_pairs_is_no_loop_whatever_the_limits_are(first):
    poses, sweeps = first
    limits = LoopConfig(max_rmse=np.inf, min_inliers=0, gate=np.inf)
    for points in (0, 7, None):
        found = verify_loop(poses, [*sweeps[:NODE], sweeps[NODE][:points]], NODE, OLD, limits)
        what = f"a loop of {found.inliers} pairs, of which 8 are needed"
        assert found.accepted == (points is None), f"{what}: accepted is {found.accepted}"


@pytest.mark.filterwarnings("error")
def test_a_loop_without_pairs_is_rejected(first):
    far = verify_loop(*moved(first, (50.0, 0.0, 0.0)), NODE, OLD)
    assert far.inliers == 0 and not far.accepted, f"{far.inliers} pairs of a belief 50 m off"
    assert np.allclose(far.information, np.eye(3)), "no pair says anything, so the ridge is left"
