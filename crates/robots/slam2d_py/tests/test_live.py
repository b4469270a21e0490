"""A robot that drives, whose server is the official one of Foxglove's WebSocket protocol."""

import logging
import os
import signal
import socket
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import rustslam2d as rs
from conftest import ROOT, program, skip

RECORDING = ROOT.parent / "shared/data/field/base/base.mcap"


@pytest.fixture
def official():
    """Starts servers that send the recording, and returns their addresses."""
    if not RECORDING.is_file():
        skip("a robot's official server", "its recording is not in ../shared/data/field, beside the repository")
    with_servers = []

    def start(*options):
        script = [sys.executable, ROOT / "tests/official_robot.py", RECORDING, *options]
        server = subprocess.Popen(script, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        with_servers.append(server)
        return server.stdout.readline().strip()

    yield start
    for server in with_servers:
        server.stdin.close()
        server.wait()
        server.stdout.close()


def trajectory(sensor, frames):
    slam = rs.Slam(sensor=sensor)
    for ranges, odometry, stamp in frames:
        slam.step(ranges, odometry, stamp)
    slam.conclude()
    return slam.poses


def test_a_robot_in_python_has_the_scans_and_the_trajectory_of_its_recording(official, tmp_path, caplog):
    caplog.set_level(logging.INFO)
    sensor, of_file = rs.Pipeline(RECORDING).frames()
    frames = []
    with rs.connect(official(), recording=tmp_path / "drive.mcap") as robot:
        assert repr(robot.sensor) == repr(sensor)
        for frame in robot:
            frames.append(frame)
            if len(frames) == len(of_file):
                robot.close()
    assert "reads /scan (sensor_msgs/msg/LaserScan)" in caplog.text
    assert len(frames) == len(of_file) and robot.remarks == []
    for one, other in zip(frames, of_file):
        assert np.array_equal(one[0], other[0], equal_nan=True) and one[2] == other[2]
        assert np.array_equal(one[1], other[1]) if one[1] is not None else other[1] is None
    assert np.array_equal(trajectory(sensor, frames), trajectory(sensor, of_file))
    again = rs.Pipeline(tmp_path / "drive.mcap").frames()[1]
    assert [frame[2] for frame in again] == [frame[2] for frame in of_file]
    with pytest.raises(FileExistsError):
        rs.connect(official(), recording=tmp_path / "drive.mcap")


def test_slam2d_live_has_the_result_of_the_recording_and_ends_by_ctrl_c(official, slam2d, tmp_path):
    drive, recorded = tmp_path / "drive", tmp_path / "drive/recording.mcap"
    live = subprocess.Popen([program("slam2d"), "live", official(), "-o", drive], stderr=subprocess.PIPE, text=True)
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


def test_a_robot_that_is_not_there_is_named(official, tmp_path):
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        nobody = f"ws://127.0.0.1:{listener.getsockname()[1]}"
        with pytest.raises(ConnectionError, match="start foxglove_bridge on the robot, and check address and port"):
            rs.connect(nobody)
    for url, said in (("robot:8765", "is not the address of a robot"), ("wss://robot:8765", "forward the port with ssh")):
        with pytest.raises(rs.ChoiceError, match=said):
            rs.connect(url)
    with pytest.raises(rs.ChoiceError, match="wait has to be within 0 to 86400 s, not -1"):
        rs.connect(nobody, wait=-1)
    without = rs.connect(official("--without", "/scan"), wait=0.1)
    with pytest.raises(rs.LogError, match=r"no scan came; it has .*/odom .*choose with scan_topic, or wait longer"):
        without.sensor
    assert list(without) == []


def test_a_server_of_another_kind_is_named():
    server = socket.create_server(("127.0.0.1", 0))

    def answer():
        client, _ = server.accept()
        with client:
            client.recv(4096)
            client.sendall(b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n")

    thread = threading.Thread(target=answer)
    thread.start()
    with server, pytest.raises(ConnectionError, match="not a server of Foxglove's WebSocket protocol: it answers HTTP 400"):
        rs.connect(f"ws://127.0.0.1:{server.getsockname()[1]}")
    thread.join()


def test_ctrl_c_ends_the_waiting_for_a_connection_and_for_a_scan(official, interrupt, interrupted):
    with socket.create_server(("127.0.0.1", 0)) as silent:
        interrupt()
        with pytest.raises(interrupted):
            rs.connect(f"ws://127.0.0.1:{silent.getsockname()[1]}")
    with rs.connect(official("--without", "/scan")) as robot:
        interrupt()
        with pytest.raises(interrupted):
            next(robot)
