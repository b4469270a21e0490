"""7. Place recognition by range histograms."""

import numpy as np
import pytest
import rustslam2d as rs
from range_histogram import chi2_distance, detect_by_histogram, range_histogram


def seen(ranges):
    ranges = np.asarray(ranges, dtype=float)
    return np.column_stack([np.zeros(len(ranges)), -ranges])


def test_the_distance_is_that_of_chi_squared():
    # By hand: shares (½, ¼, ¼) and (¼, ¾, 0) give ½ (1/16 / ¾ + ¼ / 1 + 1/16 / ¼) = 7/24.
    of = lambda ranges: range_histogram(seen(ranges), 6.0)
    a, b = of([0.5, 0.5, 2.0, 3.0]), of([0.5, 2.0, 2.0, 2.0])
    assert chi2_distance(a, b) == pytest.approx(7 / 24, abs=1e-12)
    assert chi2_distance(a, b) == chi2_distance(b, a), "it is symmetric"
    assert chi2_distance(a, a) == 0, "of equals"
    assert chi2_distance(of([1.0]), of([4.0])) == 1, "without a common bin"


def test_a_turn_changes_nothing_and_a_return_beyond_the_last_bin_counts_in_it():
    points = seen([0.05, 0.1, 2.0, 5.99, 7.5])
    shares = range_histogram(points, 6.0)
    assert np.shape(shares) == (64,), (
        f"the histogram has the shape {np.shape(shares)}, expected (64,): a range of max_range or more counts in the last bin, 63")
    # Bins of 6 m / 64 = 0.094 m.
    for bin, share in ((0, 0.2), (1, 0.2), (21, 0.2), (63, 0.4)):
        assert shares[bin] == pytest.approx(share, abs=1e-12), f"bin {bin}"
    assert np.array_equal(range_histogram(rs.transform((0, 0, 2.1), points), 6.0), shares), "a turn"
    assert range_histogram(points, 12.0)[10] == pytest.approx(0.2, abs=1e-12), "bins of 12 m / 64"
    assert np.array_equal(range_histogram(np.zeros((0, 2)), 6.0), np.zeros(64)), "no points"


def test_the_proposals_on_the_lap_are_those_within_the_distance_in_their_order(lap):
    _, sweeps = lap
    # By another path: all distances at once, from numpy.histogram.
    edges = np.append(np.linspace(0, 6, 65)[:-1], np.inf)
    shares = np.array([np.histogram(np.hypot(*sweep.T), edges)[0] / len(sweep) for sweep in sweeps])
    proposed = 0
    for node, here in enumerate(shares):
        both = shares + here
        distances = 0.5 * np.sum(np.divide((shares - here) ** 2, both, out=np.zeros_like(both), where=both > 0), axis=1)
        old = [k for k in np.argsort(distances, kind="stable") if k + 22 <= node and distances[k] <= 0.3]
        found = list(detect_by_histogram(sweeps, node, 22, 6.0, 0.3))
        assert found == old, f"node {node}: {found}, expected {old}"
        proposed += len(found)
    assert proposed > 10, f"{proposed} proposals are too few to compare"


def test_of_equals_the_older_comes_first_and_the_young_are_left_out():
    sweeps = [seen([1.0, 2.0])] * 6
    assert list(detect_by_histogram(sweeps, 5, 3, 6.0, 0.15)) == [0, 1, 2]
    assert list(detect_by_histogram(sweeps, 2, 3, 6.0, 0.15)) == []
    assert list(detect_by_histogram(sweeps, 5, 0, 6.0, 0.15)) == [0, 1, 2, 3, 4], "a node is not its own loop"
    limit = chi2_distance(range_histogram(sweeps[0], 6.0), range_histogram(seen([1.0, 4.0]), 6.0))
    assert list(detect_by_histogram([*sweeps[:3], seen([1.0, 4.0])], 3, 1, 6.0, limit)) == [0, 1, 2], "≤, not <"
