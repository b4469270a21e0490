"""The functions that are marked: those of the folder above, or of EXERCISES; and the chapter's lap."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest
import rustslam2d as rs

ABOVE = Path(__file__).resolve().parent.parent
sys.path[:0] = [os.environ.get("EXERCISES", str(ABOVE)), str(ABOVE)]


def assert_same_pose(found, expected, tolerance, what="the pose"):
    """Fails if two poses are farther apart than `tolerance`, m and rad added."""
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    assert found.shape == (3,), f"{what} must have the shape (3,), not {found.shape}"
    x, y, theta = rs.between(expected, found)
    apart = np.hypot(x, y) + abs(theta)
    assert apart < tolerance, f"{what} is {found}, expected {expected}: {apart:.2e} apart, at most {tolerance:.0e} is allowed"


@pytest.fixture(scope="session")
def lap():
    """The chapter's lap, seed 0xC0FFEE, without loops: up to the first one it is the lap with them."""
    drive = rs.simulate()
    slam = rs.Slam.chapter(sensor=drive.sensor, start=drive.truth[0], loops=False)
    for frame in zip(drive.ranges, drive.odometry, drive.stamps):
        slam.step(*frame)
    return slam.poses, [slam.scan(k) for k in range(len(slam.poses))]
