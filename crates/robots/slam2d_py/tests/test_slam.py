"""The estimator for robots and its settings."""

import numpy as np
import pytest
import rustslam2d as rs


def drive_with(drive, **keywords):
    slam = rs.Slam(sensor=drive.sensor, start=drive.truth[0], **keywords)
    for frame in zip(drive.ranges, drive.odometry, drive.stamps):
        slam.step(*frame)
    slam.conclude()
    return slam


@pytest.fixture(scope="module")
def mapped(drive):
    return drive_with(drive)


def test_the_estimator_for_robots_maps_the_lap(drive, mapped):
    assert mapped.frames == len(drive) and len(mapped.poses) == len(mapped.keyframes) == len(mapped.graph)
    errors = np.hypot(*(mapped.poses - drive.truth[mapped.keyframes])[:, :2].T)
    # Dead reckoning ends 2.4 m off.
    assert errors.max() < 0.3, errors
    covariances = mapped.covariances()
    assert covariances.shape == (len(mapped.poses), 3, 3)
    # A keyframe is off by 5 standard deviations at most.
    sigmas = np.sqrt(covariances[1:, :2, :2].trace(axis1=1, axis2=2))
    assert (errors[1:] < 5 * sigmas).all(), errors[1:] / sigmas
    assert np.hypot(*mapped.scan(0).T).max() < drive.sensor.range_max_m


def test_settings_are_those_of_the_core(drive, mapped):
    names = rs.settings()
    default, unit, about = names["loops.max_window_m"]
    assert (default, unit) == (20.0, "m") and "radius" in about
    far = drive_with(drive, config={"keyframe_distance_m": 2.0, "loops": {"min_path_m": 4.0}})
    same = drive_with(drive, config={"keyframe_distance_m": 2.0, "loops.min_path_m": 4.0})
    assert np.array_equal(far.poses, same.poses) and len(far.poses) < len(mapped.poses)
    stated = {name: value for name, (value, _, _) in names.items()}
    assert np.array_equal(drive_with(drive, config=stated).poses, mapped.poses)


@pytest.mark.parametrize(
    ("config", "said"),
    [
        ({"reach": 1.0}, f"the estimator has no parameter reach; it has {', '.join(rs.settings())}"),
        ({"loops": {"reach": 1}}, f"the estimator has no parameter loops.reach; it has {', '.join(rs.settings())}"),
        ({"keyframe_distance_m": -1.0}, "keyframe_distance_m must be positive and at most 1000000, not -1"),
        ({"keyframe_distance_m": "far"}, "keyframe_distance_m has to be a number"),
    ],
)
def test_a_wrong_setting_is_rejected_in_the_words_of_the_core(drive, config, said):
    for reject in (lambda: rs.Slam(config, sensor=drive.sensor), lambda: rs.Pipeline(__file__, config)):
        with pytest.raises(rs.SettingError) as rejected:
            reject()
        assert str(rejected.value) == said


def test_a_scan_that_cannot_be_used_leaves_the_estimator_as_it_was(drive):
    slam = rs.Slam(sensor=drive.sensor)
    first = slam.step(drive.ranges[0])
    assert (first.frame, first.keyframe, first.inliers, first.rmse, first.loops) == (0, 0, None, None, [])
    with pytest.raises(rs.FrameError) as rejected:
        slam.step(drive.ranges[1], stamp=0.0)
    assert str(rejected.value) == "the frame's stamp 0 s is not after the last one, 0 s; sort the frames by time"
    with pytest.raises(rs.ArrayError, match=r"ranges has to have the shape \(n,\), not \(2, 60\)"):
        slam.step(drive.ranges[1].reshape(2, 60))
    assert slam.frames == 1
    # NaN is no point.
    seen = drive.ranges[1].copy()
    seen[::7] = np.nan
    assert slam.step(seen, drive.odometry[1]).inliers > 8
    with pytest.raises(IndexError, match="there is no keyframe 5: the estimator has"):
        slam.scan(5)


def test_before_the_first_scan_there_is_nothing(drive):
    slam = rs.Slam(sensor=drive.sensor)
    assert slam.conclude() == [] and slam.frames == 0 and slam.poses.shape == (0, 3)
    assert slam.covariances().shape == (0, 3, 3) and len(slam.graph) == 0
    chapter = rs.Slam.chapter(sensor=drive.sensor)
    assert chapter.conclude() == [] and chapter.covariances().shape == (0, 3, 3)


def test_a_graph_that_cannot_be_optimized_is_an_error_at_the_end(drive):
    slam = rs.Slam(sensor=drive.sensor)
    for k in range(20):
        # Once in a unit of its own.
        slam.step(drive.ranges[k], (1e200, 0, 0) if k == 10 else drive.odometry[k])
    with pytest.raises(rs.OptimizeError, match="the map does not follow its newest loops: .* too large a value"):
        slam.conclude()


def test_a_sensor_says_where_its_points_are(drive):
    sensor = rs.Sensor(first_angle_rad=0.0, angle_step_rad=np.pi / 2, range_max_m=5.0, body_from_sensor=(1, 0, np.pi))
    assert np.allclose(sensor.points([2.0, 0.0, 5.0, 1.0]), [[-1.0, 0.0], [1.0, 1.0]], atol=1e-12)
    assert np.array_equal(sensor.body_from_sensor, (1, 0, np.pi)) and sensor.beam_interval_s == 0.0
    assert (sensor.first_angle_rad, sensor.range_min_m, sensor.range_max_m) == (0.0, 0.0, 5.0)
    assert sensor.angle_step_rad == np.pi / 2
    with pytest.raises(rs.FrameError) as rejected:
        rs.Sensor(first_angle_rad=0.0, angle_step_rad=0.0)
    assert str(rejected.value) == "the scan's angle step is 0; give radians other than 0"
