"""A user's program passes both type checkers at their strictest, and a wrong one does not."""

import json
import subprocess
import sys

import pytest

PROGRAM = """
import numpy as np
import numpy.typing as npt
import rustslam2d as rs

points: npt.NDArray[np.float64] = np.zeros((9, 2))
found = rs.icp(points, points, init=np.eye(3), variant="point-to-point", trim=0.1)
if found.converged and found.covariance is not None:
    print(found.pose[0], found.matrix.shape, found.covariance[0, 0], found.unobservable, found.stop)
print(rs.Ndt(points, cell=0.5).align(points).pose, rs.normals(points, radius=0.3).shape)
graph = rs.PoseGraph()
graph.add_edge(graph.add_node((0, 0, 0), fixed=True), graph.add_node([1, 0, 0]), np.eye(4), np.eye(3))
print(graph.optimize(max_iterations=5), graph.poses[0], rs.chi2_gate(0.95))
drive = rs.simulate(seed=7)
slam = rs.Slam.load("office.slam2d", sensor=drive.sensor)
for ranges, odometry, stamp in zip(drive.ranges, drive.odometry, drive.stamps):
    print(slam.step(ranges, odometry, stamp).matrix_3d)
slam.map(0.05).save("map.yaml")
fix = rs.Localizer(slam, sensor=drive.sensor, start=np.eye(3)).step([1.0, 2.0], stamp=0.0)
print(fix.verdict, None if fix.pose is None else fix.pose[2], fix.score)
run = rs.Pipeline("log.mcap", {"keyframe_distance_m": 1.0}, odometry="force", heights=(0.1, 0.4)).run(progress=True)
rs.save_tum("ours.tum", run.stamps, run.trajectory)
"""
#: The end of a program, and whether it is wrong.
PROGRAMS = {
    "": False,
    "print(rs.icp(points).pose)": True,
    'graph.optimize(max_iterations="5")': True,
    "print(found.poses)": True,
}


@pytest.mark.parametrize("checker", ["mypy", "pyright"])
def test_a_program_is_typed_at_the_strictest(tmp_path, checker):
    files = []
    for number, end in enumerate(PROGRAMS):
        files.append(tmp_path / f"program_{number}.py")
        files[-1].write_text(PROGRAM + end + "\n")
    (tmp_path / "pyrightconfig.json").write_text('{"typeCheckingMode": "strict"}')
    command = {
        "mypy": ["mypy", "--strict", "--output", "json", *map(str, files)],
        "pyright": ["basedpyright", "--outputjson", "--pythonpath", sys.executable, "--project", str(tmp_path)],
    }[checker]
    done = subprocess.run([sys.executable, "-m", *command], cwd=tmp_path, capture_output=True, text=True)
    if checker == "mypy":
        found = [(error["file"], error["message"]) for error in map(json.loads, done.stdout.splitlines())]
    else:
        found = [(one["file"], one["message"]) for one in json.loads(done.stdout)["generalDiagnostics"]]
    for file, is_wrong in zip(files, PROGRAMS.values()):
        told = [message for path, message in found if path.endswith(file.name)]
        assert bool(told) == is_wrong, (file.name, told, done.stderr)
