"""The canonical lap from Python, to the bit."""

import json

import numpy as np
import pytest
import rustslam2d as rs


def test_the_lap_has_the_bits_of_the_command(lap, drive, driven):
    slam, steps = driven
    ticks = lap["per_tick"]
    assert np.array_equal(drive.truth[1:], [tick["truth"] for tick in ticks])
    assert np.array_equal(drive.dead_reckoning[1:], [tick["dead_reckoning"] for tick in ticks])
    assert np.array_equal([step.pose for step in steps[1:]], [tick["estimate"] for tick in ticks])
    assert [step.inliers for step in steps[1:]] == [tick["inliers"] for tick in ticks]
    assert [step.rmse for step in steps[1:]] == [tick["rmse_m"] for tick in ticks]
    assert np.array_equal(slam.poses, lap["keyframe_poses"])
    assert np.array_equal(drive.truth[slam.keyframes], lap["keyframe_truth"])
    assert (steps[-1].chi2, len(slam.graph)) == (lap["chi2"], lap["keyframes"])
    accepted = [tried for step in steps for tried in step.loops if tried["accepted"]]
    events = [event["verification"] for event in lap["events"] if event["effect"]]
    assert [(tried["from"], tried["to"], tried["chi2"]) for tried in accepted] == [
        (event["from_node"], event["candidate"]["node"], event["gate"]["chi2"]) for event in events
    ]


def test_without_loops_the_front_end_is_alone(ch16, drive):
    slam = rs.Slam.chapter(sensor=drive.sensor, start=drive.truth[0], loops=False)
    for frame in zip(drive.ranges, drive.odometry, drive.stamps):
        slam.step(*frame)
    alone = json.loads(ch16("lap", "--no-loops", "--json"))
    assert np.array_equal(slam.poses, alone["keyframe_poses"])


def test_another_seed_is_another_drive_and_a_world_another_course(drive):
    other = rs.simulate(7, 0.0)
    # Without noise of the wheels they report the truth, up to rounding.
    assert np.allclose(other.dead_reckoning, other.truth, atol=1e-9)
    assert not np.array_equal(other.ranges, drive.ranges)
    ring = rs.simulate(world="ring")
    assert len(ring) != len(drive) and ring.ranges.shape == (len(ring), 120)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"seed": -1}, "seed has to be a whole number from 0 to 4294967295, not -1"),
        ({"noise": -1.0}, "noise has to be within 0 to 100, not -1"),
        ({"noise": float("nan")}, "noise has to be within 0 to 100, not NaN"),
        ({"world": "moon"}, 'world has to be one of apartment, ring, twins, corridor, hall, not "moon"'),
    ],
)
def test_what_cannot_be_simulated_is_rejected_in_a_sentence(arguments, said):
    with pytest.raises(rs.ChoiceError) as rejected:
        rs.simulate(**arguments)
    assert str(rejected.value) == said
