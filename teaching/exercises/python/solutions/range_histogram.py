"""7. Place recognition by range histograms."""

import numpy as np

#: Number of bins.
BINS = 64


def range_histogram(points, max_range):
    """Shares of the points by their distance from the sensor."""
    points = np.asarray(points).reshape(-1, 2)
    bins = np.minimum(np.hypot(*points.T) * (BINS / max_range), BINS - 1).astype(int)
    return np.bincount(bins, minlength=BINS) / max(len(points), 1)


def chi2_distance(a, b):
    """½ Σ (a − b)²/(a + b)."""
    filled = a + b > 0
    a, b = a[filled], b[filled]
    return 0.5 * np.sum((a - b) ** 2 / (a + b))


def detect_by_histogram(sweeps, node, min_gap, max_range, max_distance):
    """The nodes whose scans are similar to `node`'s, the most similar first."""
    here = range_histogram(sweeps[node], max_range)
    old = range(min(node, max(node + 1 - min_gap, 0)))
    alike = [(chi2_distance(range_histogram(sweeps[k], max_range), here), k) for k in old]
    return [k for distance, k in sorted(alike) if distance <= max_distance]
