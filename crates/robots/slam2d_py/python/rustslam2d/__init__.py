"""Scan matching and pose-graph SLAM for a planar laser.

A pose is an array (x, y, θ) of shape (3,), in m, m, rad; poses are of shape (n, 3), points of shape (n, 2), m.
Covariances and informations have the order x, y, θ and belong to perturbations on the right of a pose. Every result
has the same bits on every machine, and those of the command `slam2d`.
"""

from . import _rustslam2d
from ._rustslam2d import *  # noqa: F403
from ._rustslam2d import __version__ as __version__

__all__ = [name for name in _rustslam2d.__all__ if not name.startswith("_")]
