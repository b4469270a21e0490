"""ICP and NDT by numbers that are worked out beside them."""

import numpy as np
import pytest
import rustslam2d as rs

SQUARE = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
MOVED = np.array([[2.8, 1.6], [1.4, 1.8], [1.2, 0.4], [2.6, 0.2]])
POSE = (0.08, -0.05, 0.04)


@pytest.fixture(scope="module")
def room():
    """Two walls that meet in a corner, and a third at an angle."""
    along = np.linspace(0.0, 3.0, 150)
    walls = [(along, 0 * along), (0 * along, along), (3.0 - 0.3 * along, along)]
    return np.concatenate([np.stack(wall, axis=1) for wall in walls])


def test_the_worked_example_of_the_chapter_comes_out_in_one_increment():
    found = rs.icp(SQUARE, MOVED, init=(2.0, 1.0, 0.6), variant="point-to-point", min_pairs=4)
    assert np.allclose(found.pose, (2.0, 1.0, np.arctan2(3.0, 4.0)), atol=1e-12)
    assert (found.converged, found.stop, found.inliers) == (True, "small-step", 4)
    assert np.array_equal(found.pairs, [[0, 0], [1, 1], [2, 2], [3, 3]])
    assert found.rmse < 1e-12


@pytest.fixture(scope="module")
def posts():
    """Points that stand apart: the nearest one is the right one. Along a wall it need not be."""
    columns, rows = np.meshgrid(np.arange(5.0), np.arange(5.0))
    return np.stack([columns.ravel(), rows.ravel()], axis=1) + np.random.default_rng(2).uniform(-0.2, 0.2, (25, 2))


@pytest.mark.parametrize(("variant", "points"), [("point-to-plane", "room"), ("point-to-point", "posts")])
def test_a_moved_cloud_is_moved_back(request, variant, points):
    room = request.getfixturevalue(points)
    source = rs.transform(rs.inverse(POSE), room)
    found = rs.icp(source, room, variant=variant, max_iterations=200, tolerance=1e-10)
    # 1e-6: the last increment is below 1e-10, and ICP's shrink by a factor.
    assert np.allclose(found.pose, POSE, atol=1e-6), found
    assert np.array_equal(found.trace[0], (0, 0, 0)) and np.array_equal(found.trace[-1], found.pose)
    assert found.trace.shape == (found.iterations + 1, 3) and found.trace_rmse.shape == (found.iterations + 1,)
    assert found.trace_rmse[0] > found.trace_rmse[-1] == found.rmse
    away = rs.icp(source, room + 100.0, variant=variant)
    assert (away.converged, away.stop, away.inliers, away.rmse) == (False, "too-few-pairs", 0, np.inf)
    assert away.covariance is None


def test_the_covariance_is_that_of_the_pairs(room):
    source = rs.transform(rs.inverse(POSE), room)
    found = rs.icp(source, room, variant="point-to-point", sigma=0.03, covariance_scale=5.0)
    rotation = np.array([[np.cos(found.pose[2]), -np.sin(found.pose[2])], [np.sin(found.pose[2]), np.cos(found.pose[2])]])
    hessian = np.zeros((3, 3))
    for x, y in source[found.pairs[:, 0]]:
        # The point of a pair moves by R (v + ω J p).
        rows = np.hstack([rotation, rotation @ [[-y], [x]]])
        hessian += rows.T @ rows
    expected = hessian / (0.03**2 * 5.0)
    assert np.allclose(found.information, expected, rtol=1e-9)
    assert np.allclose(found.covariance, np.linalg.inv(expected), rtol=1e-6)


def test_pairs_are_indices_of_both_arrays(posts):
    shuffled = np.random.default_rng(0).permutation(len(posts))
    found = rs.icp(posts, posts[shuffled], variant="point-to-point")
    source, target = found.pairs.T
    assert np.array_equal(shuffled[target], source)


def test_a_corridor_leaves_a_direction_free():
    along = np.linspace(0, 10, 400)
    corridor = np.concatenate([np.stack([along, 0 * along], 1), np.stack([along, 2 + 0 * along], 1)])
    found = rs.icp(corridor, corridor)
    assert found.covariance is None and found.information[0, 0] == 0.0 < found.information[1, 1]
    assert (found.converged, found.stop) == (False, "unobservable-direction")
    assert np.allclose(np.abs(found.unobservable), (1, 0, 0), atol=1e-6)
    assert rs.icp(corridor, corridor, variant="point-to-point").unobservable is None


@pytest.mark.parametrize("variant", ["point-to-plane", "point-to-point"])
@pytest.mark.parametrize("spacing", [0.02, 0.1, 0.25, 0.4, 0.8, 2.0, 9.0])
def test_no_wrong_pose_of_an_ever_coarser_room_claims_anything(room, variant, spacing):
    _, first = np.unique(np.floor(room / spacing), axis=0, return_index=True)
    target = room[np.sort(first)]
    found = rs.icp(rs.transform(rs.inverse(POSE), target), target, variant=variant, max_iterations=200)
    if found.converged:
        # Point-to-point may be at rest one point further along each wall.
        apart = spacing if variant == "point-to-point" else 0.0
        assert np.allclose(found.pose, POSE, atol=max(0.05, apart)), found
    if found.stop in ("too-few-pairs", "too-few-normals"):
        assert found.covariance is None and not found.information.any()
    if spacing > 2 or (variant == "point-to-plane" and spacing > 0.3):
        assert found.stop == ("too-few-pairs" if spacing > 1 else "too-few-normals"), found
        wider = rs.icp(rs.transform(rs.inverse(POSE), target), target, normal_radius=3 * spacing)
        assert spacing > 0.5 or wider.stop != "too-few-normals", wider


@pytest.mark.parametrize("variant", ["point-to-plane", "point-to-point"])
def test_trimmed_until_nothing_is_left_it_claims_nothing(room, variant):
    source = rs.transform(rs.inverse(POSE), room)
    for kept in (1.0, 0.5, 7 / len(room), 0.0):
        found = rs.icp(source, room, variant=variant, trim=1.0 - kept, max_iterations=300)
        is_left = found.stop not in ("too-few-pairs", "too-few-normals")
        assert is_left == (kept >= 0.5), (kept, found)
        assert is_left or not (found.converged or found.information.any() or found.covariance is not None), found


def test_a_kernel_weights_the_information_and_may_refuse_all(room):
    source = rs.transform(rs.inverse(POSE), room) + np.random.default_rng(1).normal(0, 0.02, room.shape)
    wide, narrow = (rs.icp(source, room, huber_width=width, max_iterations=300) for width in (1.0, 0.005))
    assert narrow.converged and narrow.information[0, 0] < 0.8 * wide.information[0, 0]
    none = rs.icp(source, room, huber_width=1e-9, max_iterations=1000)
    assert not none.converged and none.stop in ("too-few-inliers", "iteration-limit")


def test_coincident_points_measure_no_rotation():
    place = np.full((20, 2), 1.5)
    found = rs.icp(place + 0.1, place, variant="point-to-point")
    assert (found.converged, found.stop) == (False, "unobservable-direction")
    assert np.allclose(found.unobservable, (0, 0, 1)) and found.covariance is None


def test_ndt_without_points_in_cells_has_not_converged(room):
    assert rs.Ndt(room).align(room + 50.0).stop == "too-few-points"
    assert not rs.Ndt(room[::20], min_points=8).align(room).converged
    assert rs.Ndt(room).align(rs.transform(rs.inverse(POSE), room), max_iterations=300).stop != "too-few-points"


def test_matrices_go_in_and_out(room):
    source = rs.transform(rs.inverse(POSE), room)
    found = rs.icp(source, room, init=POSE)
    assert np.allclose(found.matrix[:2, :2] @ found.matrix[:2, :2].T, np.eye(2)) and found.matrix[0, 2] == found.pose[0]
    space = np.eye(4)
    space[:2, :2], space[:2, 3] = found.matrix[:2, :2], found.matrix[:2, 2]
    assert np.array_equal(found.matrix_3d, space)
    for matrix in (found.matrix, space, space.astype(np.float32)):
        assert np.allclose(rs.icp(source, room, init=matrix, max_iterations=0).pose, found.pose, atol=1e-6)
        assert np.allclose(rs.Ndt(room).align(source, init=matrix, max_iterations=0).pose, found.pose, atol=1e-6)
    for wrong in (np.diag([1.0, -1, 1]), 2 * np.eye(3), np.diag([1.0, 1, 1, 0]), space + [[0, 0, 0.1, 0]] * 4):
        with pytest.raises(rs.ArrayError, match="not a motion of the plane"):
            rs.icp(source, room, init=wrong)
    with pytest.raises(rs.ArrayError, match=r"\(3,\), \(3, 3\) or \(4, 4\), not \(2, 2\)"):
        rs.icp(source, room, init=np.eye(2))


def test_without_normals_point_to_plane_claims_nothing():
    columns, rows = np.meshgrid(np.arange(6.0), np.arange(6.0))
    coarse = np.stack([columns.ravel(), rows.ravel()], axis=1)
    found = rs.icp(coarse + 0.2, coarse)
    assert (found.converged, found.stop, found.covariance) == (False, "too-few-normals", None)
    assert not found.information.any() and np.array_equal(found.pose, (0, 0, 0))


def test_ndt_climbs_to_where_the_cloud_lies(room):
    ndt = rs.Ndt(room)
    source = rs.transform(rs.inverse(POSE), room)
    found = ndt.align(source)
    assert np.allclose(found.pose, POSE, atol=0.01), found
    assert found.score == ndt.score(source, found.pose) > ndt.score(source)
    assert found.stop in ("small-gradient", "no-better-step", "iteration-limit")
    assert ndt.align(source, max_iterations=1).iterations == 1
    cells = np.floor(room / 0.6)
    first = room[(cells == cells[0]).all(axis=1)]
    assert np.allclose(ndt.means[0], first.mean(axis=0))
    assert ndt.covariances.shape == (len(ndt.means), 2, 2)


@pytest.mark.parametrize(
    ("keywords", "said"),
    [
        ({"variant": "plane"}, 'variant has to be one of point-to-plane, point-to-point, not "plane"'),
        ({"max_distance": 0.0}, "max_distance has to be within 0.000001 to 1000000 m, not 0"),
        ({"trim": 1.5}, "trim has to be within 0 to 1, not 1.5"),
        ({"sigma": float("nan")}, "sigma has to be within 0.000001 to 1000000 m, not NaN"),
        ({"normal_radius": -1}, "normal_radius has to be within 0.000001 to 1000000 m, not -1"),
    ],
)
def test_an_argument_out_of_its_range_is_rejected_in_a_sentence(room, keywords, said):
    with pytest.raises(rs.ChoiceError) as rejected:
        rs.icp(room, room, **keywords)
    assert str(rejected.value) == said


def test_ndt_rejects_cells_that_cannot_be(room):
    with pytest.raises(rs.ChoiceError, match="cell has to be within"):
        rs.Ndt(room, cell=0.0)
    with pytest.raises(rs.ChoiceError, match="one point has no covariance"):
        rs.Ndt(room, min_points=1)


def test_empty_clouds_end_without_pairs():
    nothing = np.zeros((0, 2))
    assert rs.icp(nothing, SQUARE).stop == "too-few-pairs"
    assert rs.icp(SQUARE, nothing).stop == "too-few-pairs"
    away = rs.Ndt(nothing).align(SQUARE)
    assert (away.score, away.stop) == (0.0, "too-few-points")
