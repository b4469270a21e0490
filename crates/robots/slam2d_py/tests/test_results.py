"""What a user does with a result: print, copy, pickle, save, draw."""

import copy
import pickle

import numpy as np
import pytest
import rustslam2d as rs


@pytest.fixture(scope="module")
def run(drive, tmp_path_factory):
    log = tmp_path_factory.mktemp("log") / "lap.jsonl"
    drive.write_log(log)
    return rs.Pipeline(log).run()


def test_results_print_copy_and_pickle(drive, driven, run):
    points = [drive.sensor.points(ranges) for ranges in drive.ranges[:2]]
    things = [
        drive, drive.sensor, driven[0].graph, driven[1][29], driven[0].map(0.1), run,
        rs.icp(*points), rs.Ndt(points[1]).align(points[0]), driven[0].graph.optimize(),
    ]
    for thing in things:
        for other in (pickle.loads(pickle.dumps(thing)), copy.copy(thing), copy.deepcopy(thing)):
            assert type(other) is type(thing) and repr(other) == repr(thing) and " object at " not in repr(thing)
            for name in (name for name in dir(thing) if not name.startswith("_")):
                value = getattr(thing, name)
                if isinstance(value, np.ndarray):
                    assert np.array_equal(getattr(other, name), value, equal_nan=True), name
    assert rs.__version__.count(".") == 2


def test_the_live_map_is_that_of_a_run_over_the_same_scans(drive, run):
    slam = rs.Slam(sensor=drive.sensor)
    for frame in zip(drive.ranges, drive.odometry, drive.stamps):
        slam.step(*frame)
    slam.conclude()
    live = slam.map(0.05)
    # The log has poses of odometry, from which motions round differently.
    assert live.log_odds.shape == run.map.log_odds.shape and np.allclose(live.origin, run.map.origin)
    same = np.isclose(live.log_odds, run.map.log_odds)
    assert live.cell == 0.05 and same.mean() > 0.99, same.mean()
    with pytest.raises(rs.SlamError, match="no scan has a point"):
        rs.Slam(sensor=drive.sensor).map()
    with pytest.raises(rs.ChoiceError, match="resolution has to be within"):
        slam.map(-1)


def test_a_map_and_a_trajectory_are_saved(run, drive, tmp_path):
    run.map.save(tmp_path / "map.yaml")
    assert "image: map.pgm" in (tmp_path / "map.yaml").read_text()
    assert (tmp_path / "map.pgm").read_bytes().startswith(b"P5")
    with pytest.raises(rs.ChoiceError, match="path has to end in .yaml"):
        run.map.save(tmp_path / "map.png")
    run.save_tum(tmp_path / "run.tum")
    rs.save_tum(tmp_path / "again.tum", run.stamps, run.trajectory)
    lines = np.loadtxt(tmp_path / "run.tum")
    assert np.array_equal(lines[:, :3], np.column_stack([run.stamps, run.trajectory[:, :2]]))
    assert (tmp_path / "run.tum").read_text() == (tmp_path / "again.tum").read_text()
    grid = rs.GridMap(np.array([[0.0, 2.0], [-2.0, 0.0]]), origin=(1, 2), cell=0.5)
    assert (grid.origin, grid.cell, grid.log_odds[0, 1]) == ((1, 2), 0.5, 2.0)
    with pytest.raises(FileNotFoundError):
        run.save_tum(tmp_path / "nowhere/run.tum")


def test_a_run_is_drawn(run):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")
    for thing in (run, run.map):
        ax = thing.plot()
        assert ax.get_xlabel() == "x in m" and ax.images
        assert thing.plot(ax=ax) is ax
    pyplot.close("all")


def test_a_log_without_topics_rejects_one(drive, tmp_path):
    log = tmp_path / "lap.jsonl"
    drive.write_log(log)
    with pytest.raises(rs.LogError, match="has no odom-topic /odom; only a recording of ROS has topics"):
        rs.Pipeline(log, odom_topic="/odom").run()


def test_a_robot_is_localized_on_the_map_of_an_estimator(drive):
    slam = rs.Slam(sensor=drive.sensor, start=drive.truth[0])
    for frame in zip(drive.ranges, drive.odometry, drive.stamps):
        slam.step(*frame)
    slam.conclude()
    localizer = rs.Localizer(slam, sensor=drive.sensor, start=drive.truth[0])
    errors, verdicts = [], set()
    for ranges, odometry, stamp, truth in zip(drive.ranges, drive.odometry, drive.stamps, drive.truth):
        fix = localizer.step(ranges, odometry, stamp=stamp)
        verdicts.add(fix.verdict)
        if fix.verdict in ("found", "tracking"):
            errors.append(np.hypot(*(fix.pose - truth)[:2]))
            assert fix.covariance.shape == (3, 3) and 0 < fix.score <= 1
    # The map itself is 0.3 m off at most.
    assert len(errors) > 0.8 * len(drive) and max(errors) < 0.4, (verdicts, len(errors), max(errors))
    assert "tracking" in verdicts and "Localizer(on" in repr(localizer)
    # Three points fit in many places, and one in all.
    for returns in (3, 1, 0):
        kept = np.arange(drive.ranges.shape[1]) * returns % drive.ranges.shape[1] < returns
        steps = list(zip(np.where(kept, drive.ranges, np.nan), drive.odometry, drive.stamps))
        unknown = rs.Localizer(slam, sensor=drive.sensor, start=drive.truth[0])
        blinded = rs.Localizer(slam, sensor=drive.sensor, start=drive.truth[0])
        blinded.step(drive.ranges[0], drive.odometry[0], stamp=drive.stamps[0])
        for ranges, odometry, stamp in steps[1:40]:
            fixes = [one.step(ranges, odometry, stamp=stamp) for one in (unknown, blinded)]
            assert not {"found", "tracking"} & {fix.verdict for fix in fixes}, (returns, fixes)
    assert [fix.score for fix in fixes] == [None, None], "no point fits or misses"
    with pytest.raises(rs.SlamError, match="it has taken no scan"):
        rs.Localizer(rs.Slam(sensor=drive.sensor), sensor=drive.sensor)
    with pytest.raises(FileNotFoundError):
        rs.Localizer("nowhere.slam2d", sensor=drive.sensor)
