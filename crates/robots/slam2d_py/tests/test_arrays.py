"""What comes in as an array, and what is rejected; and the motions, which are the simplest that take one."""

import numpy as np
import pytest
import rustslam2d as rs

POINTS = np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])
QUARTER = (1.0, 0.0, np.pi / 2)
TURNED = [[-1.0, 1.0], [-3.0, 3.0], [-5.0, 5.0]]


@pytest.mark.parametrize(
    "points",
    [
        POINTS,
        POINTS.astype(np.float32),
        POINTS.astype(np.int64),
        POINTS.astype(">f8"),
        np.asfortranarray(POINTS),
        np.repeat(POINTS, 2, axis=0)[::2],
        POINTS[::-1][::-1],
        np.hstack([POINTS, POINTS])[:, 1:3][:, ::-1],
        POINTS.tolist(),
        [tuple(point) for point in POINTS],
    ],
    ids=["float64", "float32", "int64", "big-endian", "fortran", "strided", "reversed", "columns", "lists", "tuples"],
)
def test_any_array_of_numbers_is_read_by_its_values(points):
    expected = TURNED if np.array_equal(points, POINTS) else None
    if expected is None:
        # The columns of this one are swapped twice over.
        expected = rs.transform(QUARTER, np.ascontiguousarray(points))
    assert np.allclose(rs.transform(QUARTER, points), expected)


def test_an_array_that_is_read_is_not_written(drive):
    points = POINTS.copy()
    points.setflags(write=False)
    assert np.allclose(rs.transform(QUARTER, points), TURNED)
    # The attributes of a result are one array each, not a copy for each look.
    assert drive.ranges is drive.ranges and drive.ranges.flags.c_contiguous and drive.ranges.dtype == np.float64


@pytest.mark.parametrize(
    ("points", "said"),
    [
        (POINTS[0], "points has to have the shape (n, 2), not (2,)"),
        (POINTS.T, "points has to have the shape (n, 2), not (2, 3)"),
        (POINTS[None], "points has to have the shape (n, 2), not (1, 3, 2)"),
        (1.0, "points has to have the shape (n, 2), not ()"),
        ([[1.0, np.nan]], "points holds a value that is not a finite number"),
        ([[1.0, np.inf]], "points holds a value that is not a finite number"),
        ("walls", "points holds text, but has to hold real numbers"),
        ([[1, 2], [3]], "points cannot be read as an array of numbers"),
        (None, "points has to have the shape (n, 2), not ()"),
    ],
)
def test_a_bad_array_is_rejected_in_a_sentence(points, said):
    with pytest.raises(rs.ArrayError) as rejected:
        rs.transform(QUARTER, points)
    assert str(rejected.value) == said
    assert isinstance(rejected.value, (rs.SlamError, ValueError))


def test_motions_make_a_group():
    a, b = (1.0, 2.0, 0.5), (-0.3, 0.7, 2.9)
    assert np.allclose(rs.compose(a, rs.inverse(a)), 0.0)
    assert np.allclose(rs.compose(a, rs.between(a, b)), b)
    # A heading beyond π comes back.
    assert rs.compose(a, b)[2] == pytest.approx(3.4 - 2 * np.pi)
    assert np.allclose(rs.exp(rs.log(b)), b)
    # A quarter of a circle with the radius 2.
    assert np.allclose(rs.exp((np.pi, 0.0, np.pi / 2)), (2.0, 2.0, np.pi / 2))
    assert np.allclose(rs.exp((0.0, 0.0, 3 * np.pi)), (0.0, 0.0, np.pi))
    with pytest.raises(rs.ArrayError, match=r"a has to have the shape \(3,\), \(3, 3\) or \(4, 4\), not \(2,\)"):
        rs.compose((1, 2), b)


@pytest.mark.parametrize(
    ("bad", "held"),
    [
        (np.ones((9, 2)) * 1j, "complex numbers"),
        (np.array([["1", "2"]] * 9), "text"),
        ([["1", 2.0]] * 9, "text"),
        (np.array([["1", 2.0]] * 9, dtype=object), "text"),
    ],
)
def test_complex_numbers_and_text_are_rejected_in_a_sentence(bad, held):
    with pytest.raises(rs.ArrayError, match=f"source holds {held}, but has to hold real numbers"):
        rs.icp(bad, np.ones((9, 2)))


def test_dates_are_rejected_and_other_real_types_are_read():
    with pytest.raises(rs.ArrayError, match="cannot be read"):
        rs.transform((0, 0, 0), np.full((9, 2), "2026-01-01", dtype="datetime64[D]"))
    for kind in (bool, np.uint8, np.float32, object):
        assert np.array_equal(rs.transform((0, 0, 0), np.ones((2, 2), dtype=kind)), np.ones((2, 2)))
