"""Functions of Python at the seams of the chapter's estimator."""

import numpy as np
import pytest
import rustslam2d as rs


def ours(source, target, init, *, normals, max_distance, max_iterations):
    settings = {"max_distance": max_distance, "max_iterations": max_iterations}
    return rs.icp(source, target, init=init, variant="point-to-point", **settings)


def test_our_icp_as_a_function_gives_the_bits_of_the_estimator(driven):
    drive = rs.simulate(icp=ours)
    assert np.array_equal(drive.slam.poses, driven[0].poses) and len(drive.steps) == len(drive)
    assert np.array_equal([step.pose for step in drive.steps], [step.pose for step in driven[1]])


def test_a_gate_decides_alone_and_is_given_the_graph_as_it_is(driven):
    asked = []

    def gate(poses, sweeps, node, candidate):
        asked.append((node, candidate))
        assert len(poses) == len(sweeps) == node + 1 and poses.shape[1] == sweeps[0].shape[1] + 1
        return False

    drive = rs.simulate(gate=gate)
    assert asked[0] == (29, 7) and all(not step.loops for step in drive.steps)
    assert len(drive.slam.graph.edges) == len(drive.slam.poses) - 1
    loops = [tried for step in rs.simulate(gate=lambda *_: True).steps for tried in step.loops]
    expected = [tried["from"] for step in driven[1] for tried in step.loops if tried["accepted"]]
    assert [tried["from"] for tried in loops if tried["accepted"]] == expected


@pytest.mark.parametrize(
    ("function", "error", "said"),
    [
        (lambda *_, **__: 1 / 0, ZeroDivisionError, "division by zero"),
        (lambda *_, **__: (1, 2), rs.ArrayError, r"the pose that icp returned has to have the shape \(3,\), \(3, 3\) or \(4, 4\), not \(2,\)"),
        (lambda *_, **__: (1, 2, np.nan), rs.ArrayError, "the pose that icp returned holds a value that is not a finite number"),
        (lambda source: 0, TypeError, "unexpected keyword argument 'normals'"),
    ],
)
def test_what_a_function_raises_the_step_raises(drive, function, error, said):
    slam = rs.Slam.chapter(sensor=drive.sensor, icp=function)
    slam.step(drive.ranges[0])
    with pytest.raises(error, match=said):
        slam.step(drive.ranges[1])
    with pytest.raises(error, match=said):
        rs.simulate(icp=function)


def test_a_function_that_reads_the_estimator_is_told_that_it_cannot(drive):
    slam = rs.Slam.chapter(sensor=drive.sensor, icp=lambda *_, **__: slam.poses[-1])
    slam.step(drive.ranges[0])
    with pytest.raises(rs.SlamError, match="calls during a step cannot read it"):
        slam.step(drive.ranges[1])
    with pytest.raises(TypeError, match="icp has to be a function, not int"):
        rs.simulate(icp=3)
