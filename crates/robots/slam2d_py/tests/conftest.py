"""What the tests share: the chapter's lap, and the command that has to come to the same bits."""

import json
import os
import signal
import subprocess
import threading
from pathlib import Path

import pytest
import rustslam2d as rs

ROOT = Path(__file__).resolve().parents[4]


def skip(name, reason):
    """Skips a test and records that, by the rules of `docs/testing.md`."""
    if os.environ.get("SLAM_NO_SKIP", "") not in ("", "0", "false"):
        pytest.fail(f"{name}: {reason}, and SLAM_NO_SKIP forbids skips")
    if "SLAM_SKIPPED" in os.environ:
        with open(os.environ["SLAM_SKIPPED"], "a", encoding="utf-8") as skipped:
            skipped.write(f"{name}: {reason}\n")
    pytest.skip(reason)


def program(name):
    """A command of the workspace."""
    folder = Path(os.environ.get("SLAM_NATIVE", ROOT / "target/debug"))
    path = folder / (f"{name}.exe" if os.name == "nt" else name)
    if not path.is_file():
        skip("the command beside the package", f"{path} is not there; cargo build --bin {name} makes it")
    return path


def command(name):
    """A function that runs a command of the workspace, and returns what it prints."""
    path = program(name)

    def run(*arguments):
        return subprocess.run([path, *map(str, arguments)], check=True, capture_output=True, text=True).stdout

    return run


@pytest.fixture(scope="session")
def slam2d():
    """The command of robots."""
    return command("slam2d")


@pytest.fixture(scope="session")
def ch16():
    """The command of the chapter's experiments."""
    return command("ch16")


@pytest.fixture(scope="session")
def lap(ch16):
    """The canonical lap as the command prints it."""
    return json.loads(ch16("lap", "--json"))


@pytest.fixture(scope="session")
def drive():
    """The drive of the canonical lap."""
    return rs.simulate()


@pytest.fixture(scope="session")
def driven(drive):
    """The chapter's estimator after that drive, with what it said of each scan."""
    slam = rs.Slam.chapter(sensor=drive.sensor, start=drive.truth[0])
    frames = zip(drive.ranges, drive.odometry, drive.stamps)
    return slam, [slam.step(*frame) for frame in frames]


class Interrupted(BaseException):
    """What the handler raises: not KeyboardInterrupt, which would end pytest if a test failed."""


@pytest.fixture
def interrupted():
    """What the handler raises."""
    return Interrupted


@pytest.fixture
def interrupt():
    """Raises a signal in a moment: the computation meanwhile would take days."""
    if not hasattr(signal, "setitimer"):
        pytest.skip("the system has no interval timer")

    def handler(*_):
        raise Interrupted

    before = signal.signal(signal.SIGALRM, handler)
    assert threading.current_thread() is threading.main_thread()
    yield lambda: signal.setitimer(signal.ITIMER_REAL, 0.02)
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)
