"""What a program that runs for weeks needs: sessions, pickles, Ctrl-C, and errors at once."""

import copy
import pickle
import signal

import numpy as np
import pytest
import rustslam2d as rs


def steps(drive, start, end):
    return list(zip(drive.ranges, drive.odometry, drive.stamps))[start:end]


def driven(drive, end):
    slam = rs.Slam(sensor=drive.sensor)
    for step in steps(drive, 0, end):
        slam.step(*step)
    return slam


@pytest.mark.parametrize("again", ["save", "pickle", "copy"])
def test_a_live_run_continues_from_its_session_with_the_same_bits(drive, tmp_path, again):
    slam = driven(drive, 60)
    if again == "save":
        slam.save(tmp_path / "office.slam2d")
        slam.save(tmp_path / "office.slam2d")
        assert [path.name for path in tmp_path.iterdir()] == ["office.slam2d"]
        other = rs.Slam.load(tmp_path / "office.slam2d")
    else:
        other = pickle.loads(pickle.dumps(slam)) if again == "pickle" else copy.deepcopy(slam)
    assert (other.frames, len(other.keyframes)) == (60, len(slam.keyframes))
    for step in steps(drive, 60, 120):
        assert np.array_equal(slam.step(*step).pose, other.step(*step).pose)
    assert np.array_equal(slam.poses, other.poses)
    assert other.map(0.1).log_odds.size > 1000


def test_a_robot_localizes_on_a_session_of_a_live_run(drive, tmp_path):
    driven(drive, 200).save(tmp_path / "office.slam2d")
    localizer = rs.Localizer(tmp_path / "office.slam2d", sensor=drive.sensor, start=(0, 0, 0))
    verdicts = [localizer.step(ranges, odometry, stamp=stamp).verdict for ranges, odometry, stamp in steps(drive, 0, 30)]
    assert verdicts[-1] == "tracking", verdicts


def test_what_cannot_be_saved_or_read_says_so(drive, tmp_path):
    with pytest.raises(rs.SlamError, match="it has taken no scan"):
        rs.Slam(sensor=drive.sensor).save(tmp_path / "a")
    chapter = rs.Slam.chapter(sensor=drive.sensor, icp=lambda source, target, init, **_: init)
    chapter.step(drive.ranges[0])
    for act in (lambda: chapter.save(tmp_path / "a"), lambda: pickle.dumps(chapter)):
        with pytest.raises(rs.SlamError, match="its parts may be your functions"):
            act()
    with pytest.raises(FileNotFoundError):
        rs.Slam.load(tmp_path / "absent.slam2d")
    (tmp_path / "text").write_text("not a session")
    with pytest.raises(rs.LogError):
        rs.Slam.load(tmp_path / "text")
    with pytest.raises(FileNotFoundError):
        driven(drive, 2).save(tmp_path / "no/such/folder")


def test_an_absent_log_is_reported_at_once(tmp_path):
    with pytest.raises(FileNotFoundError) as absent:
        rs.Pipeline(tmp_path / "nope.bag")
    assert absent.value.filename == str(tmp_path / "nope.bag")


@pytest.fixture
def log(drive, tmp_path):
    drive.write_log(tmp_path / "lap.jsonl")
    return tmp_path / "lap.jsonl"


def test_a_pickled_pipeline_runs_alike(log):
    options = {"odometry": "force", "min_range": 0.2, "footprint": (-0.1, -0.1, 0.1, 0.1), "laser": "0.1,0,0"}
    pipeline = rs.Pipeline(log, {"keyframe_distance_m": 1.0}, **options)
    again = pickle.loads(pickle.dumps(pipeline))
    assert np.array_equal(pipeline.run(cell=0.2).trajectory, again.run(cell=0.2).trajectory)


def test_every_option_of_a_run_has_an_effect_or_a_sentence(log):
    plain = rs.Pipeline(log).run(cell=0.2).trajectory
    assert np.array_equal(plain, rs.Pipeline(log, odometry=True).run(cell=0.2).trajectory)
    alone = rs.Pipeline(log, odometry="none").run(cell=0.2).trajectory
    assert np.array_equal(alone, rs.Pipeline(log, odometry=False).run(cell=0.2).trajectory)
    assert not np.array_equal(plain, alone)
    for options in ({"laser": "0.3,0,0"}, {"min_range": 2.0}, {"footprint": (-3, -3, 3, 3)}):
        assert not np.array_equal(plain, rs.Pipeline(log, **options).run(cell=0.2).trajectory), options
    for options, said in (
        ({"odometry": "wheels"}, "odometry: expected check, force, mirrored, none or a file"),
        ({"laser": "left"}, "laser: "),
        ({"heights": (2.0, 1.0)}, "heights: expected two heights, the lower one first"),
        ({"min_range": -1.0}, "min_range: expected metres within 0 to"),
        ({"footprint": (1.0, 1.0, -1.0, -1.0)}, "footprint: "),
        ({"columns": "nonsense"}, "columns: "),
    ):
        with pytest.raises(rs.ChoiceError, match=said):
            rs.Pipeline(log, **options)


def test_ctrl_c_ends_icp(interrupt, interrupted):
    points = np.random.default_rng(0).uniform(-5, 5, (2000, 2))
    interrupt()
    with pytest.raises(interrupted):
        rs.icp(points, points + 0.01, tolerance=0.0, max_iterations=1_000_000_000)


def test_ctrl_c_ends_optimize_and_the_poses_stay(interrupt, interrupted):
    graph, rng = rs.PoseGraph(), np.random.default_rng(0)
    graph.add_node((0, 0, 0), fixed=True)
    for node in range(1, 2000):
        graph.add_node((*rng.uniform(-50, 50, 2), 0))
        graph.add_edge(node - 1, node, (1, 0, 0.1), np.eye(3))
        graph.add_edge(int(rng.integers(node)), node, (*rng.uniform(-9, 9, 2), 0), np.eye(3))
    before = graph.poses
    interrupt()
    with pytest.raises(interrupted):
        graph.optimize(start="given", method="lm", tolerance=0.0, max_iterations=1_000_000)
    # Without an ear for it, the signal would come after the new poses.
    assert np.array_equal(graph.poses, before)


def test_ctrl_c_ends_a_run(log):
    # A shell starts background jobs with SIGINT ignored.
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)
    calls = []

    def progress(scans, share):
        calls.append(share)
        if len(calls) == 2:
            signal.raise_signal(signal.SIGINT)

    try:
        with pytest.raises(KeyboardInterrupt):
            rs.Pipeline(log).run(progress=progress)
    finally:
        signal.signal(signal.SIGINT, usual)
    assert calls[-1] < 1.0
