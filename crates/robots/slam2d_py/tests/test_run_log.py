"""A log through the pipeline, against what the command makes of it."""

import json

import numpy as np
import pytest
import rustslam2d as rs
from conftest import ROOT, skip


@pytest.fixture(scope="module")
def log(drive, tmp_path_factory):
    path = tmp_path_factory.mktemp("log") / "lap.jsonl"
    drive.write_log(path)
    return path


@pytest.fixture(scope="module")
def run(log):
    return rs.Pipeline(log).run()


def test_the_log_has_the_bytes_of_the_commands(ch16, log, tmp_path):
    ch16("lap", "--frames", tmp_path / "lap.jsonl")
    assert (tmp_path / "lap.jsonl").read_bytes() == log.read_bytes()


def test_a_run_is_the_commands(slam2d, log, run, tmp_path):
    slam2d("run", log, "-o", tmp_path / "out")
    assert run.quality == json.loads((tmp_path / "out/quality.json").read_text())
    assert run.graph.to_g2o() == (tmp_path / "out/graph.g2o").read_text()
    assert np.array_equal(run.keyframes, [keyframe["pose"] for keyframe in run.quality["keyframes"]])
    assert np.array_equal(run.covariances, [keyframe["covariance"] for keyframe in run.quality["keyframes"]])
    stamp, x, y = np.loadtxt(tmp_path / "out/trajectory.tum", usecols=(0, 1, 2)).T
    # As many digits as the file has.
    assert np.allclose(run.stamps, stamp, atol=1e-6) and np.allclose(run.trajectory[:, :2], np.stack([x, y], 1), atol=1e-6)
    header, size, _, pixels = (tmp_path / "out/map.pgm").read_bytes().split(b"\n", 3)
    columns, rows = map(int, size.split())
    assert header == b"P5" and run.map.log_odds.shape == (rows, columns)
    drawn = np.frombuffer(pixels, np.uint8).reshape(rows, columns)
    occupied = 1 / (1 + np.exp(-run.map.log_odds))
    assert np.array_equal(drawn == 0, occupied > 0.65)
    assert f"origin: [{run.map.origin[0]}" in (tmp_path / "out/map.yaml").read_text() and run.map.cell == 0.05


def test_a_run_is_near_the_truth_and_settings_change_it(drive, log, run):
    against_truth = rs.evaluate(run.stamps, run.trajectory, truth=(drive.stamps, drive.truth), align="se2")
    assert against_truth["n"] == len(drive) and against_truth["ate"]["rmse"] < 0.1
    rare = rs.Pipeline(log, {"keyframe_distance_m": 2.0}).run(cell=0.2, free_space=True)
    assert len(rare.keyframes) < len(run.keyframes) and rare.map.cell == 0.2
    alone = rs.Pipeline(log, odometry=False).run()
    assert not np.array_equal(alone.trajectory, run.trajectory)


def test_the_scans_of_a_log_drive_any_estimator(drive, driven, log):
    sensor, frames = rs.Pipeline(log).frames()
    assert repr(sensor) == repr(drive.sensor) and len(frames) == len(drive)
    ranges, odometry, stamps = zip(*frames)
    assert np.array_equal(ranges, drive.ranges) and np.array_equal(stamps, drive.stamps)
    # The log has poses of odometry, from which motions round differently.
    assert odometry[0] is None and np.allclose(odometry[1:], drive.odometry[1:], atol=1e-9)
    slam = rs.Slam.chapter(sensor=sensor, icp=lambda source, target, init, **_: init)
    for frame in frames:
        slam.step(*frame)
    assert slam.frames == len(drive)


def test_odometry_may_be_in_a_file_beside_a_table_of_scans(drive, tmp_path):
    scans, odometry = tmp_path / "scans.csv", tmp_path / "odom.csv"
    rows = [[stamp, -np.pi, 2 * np.pi / len(ranges), 12, *ranges] for stamp, ranges in zip(drive.stamps, drive.ranges)]
    header = "time,angle_min,angle_increment,range_max,ranges\n"
    scans.write_text(header + "".join(",".join(map(str, row)) + "\n" for row in rows))
    poses = ((stamp, *pose) for stamp, pose in zip(drive.stamps, drive.truth))
    odometry.write_text("t,x,y,theta\n" + "".join("{},{},{},{}\n".format(*pose) for pose in poses))
    moved = [motion for _, motion, _ in rs.Pipeline(scans, odometry=odometry).frames()[1]]
    steps = np.linalg.norm(np.diff(drive.truth[:, :2], axis=0), axis=1)
    # 1e-9 m: poses as text and back.
    assert np.allclose([np.hypot(*motion[:2]) for motion in moved[1:]], steps, atol=1e-9)
    assert rs.Pipeline(scans).frames()[1][1][1] is None
    with pytest.raises(FileNotFoundError):
        rs.Pipeline(scans, odometry=tmp_path / "absent.csv")
    with pytest.raises(rs.ChoiceError, match="a file such as odom.csv"):
        rs.Pipeline(scans, odometry="wheels")


def test_progress_comes_as_numbers_or_on_standard_error(log, capsys):
    told = []
    rs.Pipeline(log).run(progress=lambda scans, share: told.append((scans, share)))
    assert [scans for scans, _ in told] == sorted(scans for scans, _ in told) and len(told) >= 8
    # The share grows with the scans, and is 1 at the end, whose work takes a quarter of the time.
    assert told[-1] == (130, 1.0)
    assert max(abs(share - 0.75 * scans / 130) for scans, share in told[:-1]) < 0.1, told
    capsys.readouterr()
    rs.Pipeline(log).run(progress=True)
    assert "130 scans, 100%" in capsys.readouterr().err
    rs.Pipeline(log).run(progress=False)
    assert capsys.readouterr().err == ""
    with pytest.raises(rs.ChoiceError, match="progress has to be True, False or a function"):
        rs.Pipeline(log).run(progress="yes")


def test_what_a_progress_function_raises_ends_the_run(log):
    def stop(scans, share):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rs.Pipeline(log).run(progress=stop)


def test_a_file_that_is_no_log_is_rejected_in_a_sentence(tmp_path):
    with pytest.raises(FileNotFoundError):
        rs.Pipeline(tmp_path / "absent.mcap").run()
    empty = tmp_path / "empty.log"
    empty.write_bytes(b"")
    trajectory = tmp_path / "trajectory.tum"
    trajectory.write_text("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n")
    for path, said in [
        (empty, f"{empty} is empty; use a recorded log"),
        (trajectory, f"{trajectory} is a trajectory, not a log of scans; pass a log; slam2d evaluate evaluates a trajectory"),
        (tmp_path, f"{tmp_path} is a folder without a recording of ROS; give a log, or a folder with files that end in .mcap, .db3 or .bag"),
    ]:
        for read in (lambda: rs.Pipeline(path).run(), lambda: rs.Pipeline(path).frames()):
            with pytest.raises(rs.LogError) as rejected:
                read()
            assert str(rejected.value) == said


def test_a_log_in_which_nothing_was_seen_is_rejected(drive, log, tmp_path):
    blind = tmp_path / "blind.jsonl"
    lines = [json.loads(line) for line in log.read_text().splitlines()[:20]]
    blind.write_text("".join(json.dumps({**line, "ranges_m": [None] * 120}) + "\n" for line in lines))
    with pytest.raises(rs.LogError, match="no scan could be used"):
        rs.Pipeline(blind).run()


def test_errors_against_truth_and_relations():
    stamps = np.arange(5.0)
    truth = np.stack([stamps, 0 * stamps, 0 * stamps], axis=1)
    off = truth + (0.0, 0.5, 0.0)
    plain = rs.evaluate(stamps, off, truth=(stamps, truth))
    assert (plain["n"], plain["ate"]["rmse"], plain["rpe"]["trans"]["max"]) == (5, 0.5, 0.0)
    assert rs.evaluate(stamps, off, truth=(stamps, truth), align="se2")["ate"]["max"] < 1e-12
    by_relations = rs.evaluate(stamps, off, relations=[(0.0, 2.0, 2.0, 0.3, 0.0), (1.0, 3.0, 2.0, 0.1, np.pi / 2)])
    assert by_relations["n"] == 2 and by_relations["trans"]["mean"] == pytest.approx(0.2)
    assert by_relations["rot_deg"]["mean"] == pytest.approx(45.0)


def test_all_robots_of_a_recording_are_mapped_as_by_the_command():
    recording = ROOT.parent / "shared/data/field/two_robots/namespaced.mcap"
    if not recording.is_file():
        skip("all robots of a recording", "it is not in ../shared/data/field, beside the repository")
    run = rs.Pipeline(recording, all_robots=True).run()
    assert len(run.stamps) == 314 and (np.diff(run.stamps) > 0).all()
    assert any("the robot of /tb3_1/scan was found on the map" in said for said in run.remarks)
    with pytest.raises(rs.ChoiceError, match="all robots have topics and frames of their own"):
        rs.Pipeline(recording, all_robots=True, odom_topic="/odom")


@pytest.mark.parametrize(
    ("keywords", "error", "said"),
    [
        ({}, rs.ChoiceError, "give either truth=(stamps, poses) or relations"),
        ({"truth": ([10.0, 11.0], np.zeros((2, 3)))}, rs.EvaluationError, "0 stamps of the trajectory are within 0.01 s of"),
        ({"truth": ([1.0, 0.0], np.zeros((2, 3)))}, rs.ArrayError, "the truth's stamps has to ascend"),
        ({"truth": ([1.0], np.zeros((2, 3)))}, rs.ArrayError, "the truth's stamps has 1 entries, and the truth's poses has 2"),
        ({"relations": [(8.0, 9.0, 0, 0, 0)]}, rs.EvaluationError, "none of the 1 relations is within the times"),
        ({"relations": [(8.0, 9.0)]}, rs.ArrayError, "relations has to have the shape (n, 5), not (1, 2)"),
        ({"relations": [(8.0, 9.0, 0, 0, 0)], "align": "sim3"}, rs.ChoiceError, "align has to be one of none, se2"),
    ],
)
def test_what_cannot_be_compared_is_rejected_in_a_sentence(keywords, error, said):
    with pytest.raises(error) as rejected:
        rs.evaluate([0.0, 1.0], np.zeros((2, 3)), **keywords)
    assert str(rejected.value).startswith(said)
