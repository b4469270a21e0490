"""Whatever is wrong with a value is a SlamError of one sentence, help has no gaps, and Ctrl-C is heard."""

import inspect
import pickle
import signal
import sys

import numpy as np
import pytest
import rustslam2d as rs

POINTS = np.random.default_rng(16).uniform(-3, 3, (50, 2))


@pytest.mark.parametrize("value", [-1, 2**70, 2.5, float("nan")])
@pytest.mark.parametrize(
    "call",
    [
        lambda value: rs.icp(POINTS, POINTS, max_iterations=value),
        lambda value: rs.icp(POINTS, POINTS, min_pairs=value),
        lambda value: rs.Ndt(POINTS, min_points=value),
        lambda value: rs.Ndt(POINTS).align(POINTS, max_iterations=value),
        lambda value: rs.PoseGraph().optimize(max_iterations=value),
    ],
)
def test_a_count_is_a_whole_number_that_is_not_negative(call, value):
    with pytest.raises(rs.SlamError, match="has to be a whole number from 0 to"):
        call(value)


@pytest.mark.parametrize("value", [-1, 2**70, 0.5, 3])
@pytest.mark.parametrize(
    "call",
    [
        lambda graph, value: graph.add_edge(0, value, (1, 0, 0), np.eye(3)),
        lambda graph, value: graph.add_edge(value, 0, (1, 0, 0), np.eye(3)),
        lambda graph, value: graph.relative_covariance(0, value),
        lambda graph, value: rs.Slam(sensor=rs.Sensor(first_angle_rad=0.0, angle_step_rad=0.1)).scan(value),
    ],
)
def test_a_number_that_no_node_has_is_a_slam_error_and_an_index_error(call, value):
    graph = rs.PoseGraph()
    for x in range(3):
        graph.add_node((x, 0, 0), fixed=x == 0)
    for error in (rs.SlamError, IndexError):
        with pytest.raises(error, match="there is no (node|keyframe) .*: the (graph|estimator) has [03]"):
            call(graph, value)
    kept = pickle.loads(pickle.dumps(rs.NumberError("there is no node 3")))
    assert type(kept) is rs.NumberError and rs.NumberError.__module__ == "rustslam2d"


@pytest.mark.parametrize("seed", [-1, 2**70, 0.5])
def test_a_seed_has_32_bits(seed):
    with pytest.raises(rs.ChoiceError, match="seed has to be a whole number from 0 to 4294967295"):
        rs.simulate(seed)


def test_a_mask_is_not_lost(drive):
    masked = np.ma.masked_array(POINTS, mask=POINTS > 2)
    for call in (lambda: rs.icp(masked, POINTS), lambda: rs.normals(masked), lambda: drive.sensor.points(masked[:, 0])):
        with pytest.raises(rs.ArrayError, match="has a mask, which would be lost"):
            call()


def test_scans_without_points_and_with_other_beams_are_taken(drive):
    slam = rs.Slam(sensor=drive.sensor)
    slam.step(drive.ranges[0])
    step = slam.step(np.full(drive.ranges.shape[1], np.nan), (0.1, 0, 0))
    assert np.allclose(step.pose, (0.1, 0, 0)) and step.inliers == 0
    assert slam.step(drive.ranges[1][:60], drive.odometry[1]).inliers > 10


def test_help_shows_every_default():
    callables = [one for one in vars(rs).values() if callable(one)]
    callables += [member for one in callables if inspect.isclass(one) for member in vars(one).values()]
    for one in callables:
        assert "..." not in (getattr(one, "__text_signature__", None) or ""), one
    assert inspect.signature(rs.icp).parameters["huber_width"].default == float("inf")


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no timer signals")
def test_icp_hears_ctrl_c():
    def interrupt(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.1)
    try:
        with pytest.raises(KeyboardInterrupt):
            rs.icp(POINTS, POINTS + 0.01, max_iterations=10**9, tolerance=0.0)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
