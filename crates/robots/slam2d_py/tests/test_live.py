"""A robot that drives, whose server is the official one of Foxglove's WebSocket protocol."""

import signal
import subprocess
import sys
import time

import pytest
import rustslam2d as rs
from conftest import ROOT, program, skip

RECORDING = ROOT.parent / "shared/data/field/base/base.mcap"


@pytest.fixture
def robot():
    """The address of a server that sends the recording."""
    if not RECORDING.is_file():
        skip("a robot's official server", "its recording is not in ../shared/data/field, beside the repository")
    script = [sys.executable, ROOT / "tests/official_robot.py", RECORDING]
    server = subprocess.Popen(script, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    yield server.stdout.readline().strip()
    server.stdin.close()
    server.wait()
    server.stdout.close()


def test_slam2d_live_has_the_result_of_the_recording_and_ends_by_ctrl_c(robot, slam2d, tmp_path):
    drive, recorded = tmp_path / "drive", tmp_path / "drive/recording.mcap"
    live = subprocess.Popen([program("slam2d"), "live", robot, "-o", drive], stderr=subprocess.PIPE, text=True)
    last = rs.Pipeline(RECORDING).frames()[1][-1][0].astype("<f4").tobytes()
    # Until the last scan is recorded. The limit ends a hang, and decides nothing.
    limit = time.monotonic() + 300
    while live.poll() is None and not (recorded.is_file() and last in recorded.read_bytes()):
        assert time.monotonic() < limit
        time.sleep(0.01)
    live.send_signal(signal.SIGINT)
    said = live.communicate()[1]
    assert live.returncode == 0 and "reads /scan (sensor_msgs/msg/LaserScan)" in said, said
    slam2d("run", RECORDING, "-o", tmp_path / "file")
    for name in ("trajectory.tum", "graph.g2o", "map.pgm"):
        assert (drive / name).read_bytes() == (tmp_path / "file" / name).read_bytes(), name
