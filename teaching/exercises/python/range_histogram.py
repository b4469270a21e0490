"""7. Place recognition by range histograms (exercise 7 of the page).

Task. A search around the estimated pose fails if that pose is wrong. Propose loops by the appearance of the sweeps instead:
a histogram of ranges does not change if the robot turns.

Formula. 64 bins of equal width from 0 to max_range; longer ranges count in the last one. The histogram holds shares: they
sum to 1, or to 0 if there are no points. The χ² distance between two histograms is

    ½ Σ (aᵢ − bᵢ)² / (aᵢ + bᵢ)        over the bins in which either has a share

It is 0 for equal histograms, and 1 if they share no bin.
"""

import numpy as np

#: Number of bins.
BINS = 64


def range_histogram(points, max_range):
    """Shares of the points, shape (n, 2), by their distance from the sensor: shape (64,)."""
    raise NotImplementedError("range_histogram is not written yet: its task is in range_histogram.py")


def chi2_distance(a, b):
    """The χ² distance of two histograms, 0 to 1."""
    raise NotImplementedError("range_histogram is not written yet: its task is in range_histogram.py")


def detect_by_histogram(sweeps, node, min_gap, max_range, max_distance):
    """The nodes whose scans are similar to `node`'s: at least `min_gap` older, within `max_distance`, the most
    similar first, and among equals the older first; a list of numbers.

    sweeps[k] holds the points of node k in its own frame, max_range (m) is the range of the sensor.
    """
    raise NotImplementedError("range_histogram is not written yet: its task is in range_histogram.py")
