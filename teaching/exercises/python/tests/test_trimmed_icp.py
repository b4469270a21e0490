"""6. ICP with trimming, and a box that moved."""

import numpy as np
import pytest
import rustslam2d as rs
from conftest import assert_same_pose
from trimmed_icp import icp


@pytest.fixture(scope="module")
def clouds():
    """Two sweeps of a lap: source, target, and the true pose target_from_source."""
    drive = rs.simulate()
    source, target = (drive.sensor.points(drive.ranges[k]) for k in (14, 10))
    return source, target, rs.between(drive.truth[10], drive.truth[14])


@pytest.mark.parametrize("variant", ["point-to-point", "point-to-plane"])
def test_an_increment_is_a_motion_in_the_frame_of_the_target(clouds, variant):
    source, target, truth = clouds
    guess = rs.compose(truth, (-1, 0.5, -0.6))
    core = rs.icp(source, target, init=guess, variant=variant, max_distance=1.5, max_iterations=1)
    found = icp(source, target, guess, normals=rs.normals(target), variant=variant, max_distance=1.5, max_iterations=1)
    what = "after an increment the pose has to be compose(step, pose), and not compose(pose, step): the pose"
    assert_same_pose(found.pose, core.pose, 1e-9, what)


@pytest.mark.parametrize("variant", ["point-to-point", "point-to-plane"])
@pytest.mark.parametrize("off", [(0, 0, 0), (0.3, -0.2, 0.1), (0, 0, 1.6), (-1, 0.5, -0.6)])
def test_without_trimming_every_registration_ends_where_the_core_ends(clouds, variant, off):
    source, target, truth = clouds
    guess = rs.compose(truth, off)
    for tau, limit in ((0.7, 25), (1.5, 40), (0.7, 2)):
        core = rs.icp(source, target, init=guess, variant=variant, max_distance=tau, max_iterations=limit)
        found = icp(source, target, guess, normals=rs.normals(target), variant=variant, max_distance=tau,
                    max_iterations=limit)
        what = f"{variant} from {np.round(guess, 3)}, τ = {tau} m"
        # 1e-9: the core adds terms in a different order.
        assert_same_pose(found.pose, core.pose, 1e-9, f"{what}: the pose")
        assert len(found.trace) == core.iterations + 1, f"{what}: {len(found.trace)} poses, expected {core.iterations + 1}"
        assert np.allclose(found.trace[0], guess) and np.allclose(found.trace[-1], found.pose), f"{what}: the trace"
        assert found.inliers == core.inliers, f"{what}: {found.inliers} pairs, expected {core.inliers}"
        assert found.rmse == pytest.approx(core.rmse, abs=1e-9), f"{what}: the rmse"


def with_box(seed):
    """A room whose box moved by 0.4 m between two sweeps taken at one pose: a fifth of the points."""
    rng = np.random.default_rng(seed)
    along = np.linspace(-2, 2, 40)
    room = np.vstack([np.column_stack(xy) for xy in
                      ((along, 0 * along - 2), (along, 0 * along + 2), (0 * along - 3, along), (0 * along + 3, along))])
    box = np.column_stack([np.linspace(-0.6, 0.6, 40), np.full(40, -0.5)])
    noisy = lambda points: points + rng.normal(0, 0.01, points.shape)
    return noisy(np.vstack([room, box + [0.0, 0.4]])), noisy(np.vstack([room, box]))


def test_trimming_takes_most_of_the_pull_of_a_box_that_moved():
    bias = {0.0: [], 0.25: []}
    for seed in range(10):
        source, target = with_box(seed)
        for trim, found_at in bias.items():
            settings = {"max_distance": 0.7, "max_iterations": 30, "trim": trim}
            found = icp(source, target, np.zeros(3), **settings)
            core = rs.icp(source, target, variant="point-to-point", **settings)
            assert_same_pose(found.pose, core.pose, 1e-9, f"trim = {trim}: the pose")
            assert found.inliers == core.inliers, f"trim = {trim}: {found.inliers} pairs, expected {core.inliers}"
            found_at.append(found.pose[:2])
    plain, trimmed = (np.linalg.norm(np.mean(at, axis=0)) for at in bias.values())
    assert trimmed < plain / 3, f"the box pulls by {trimmed} m, and by {plain} m without trimming"


@pytest.mark.parametrize(("trim", "share"), [(0.257, 0.743), (0.371, 0.629)])
def test_the_longest_pairs_go(trim, share):
    source, target = with_box(1)
    found = icp(source, target, np.zeros(3), max_distance=0.7, max_iterations=30, trim=trim)
    moved = rs.transform(found.pose, source)
    squares = np.min(np.sum((moved[:, None] - target[None]) ** 2, axis=2), axis=1)
    squares = np.sort(squares[squares < 0.49])
    kept = int(np.ceil(share * len(squares)))
    assert found.inliers == kept, f"{found.inliers} of {len(squares)} pairs are kept, expected {kept}"
    assert found.rmse == pytest.approx(np.sqrt(squares[:kept].mean()), abs=1e-12), "the rmse"
    at_the_guess = icp(source, target, np.zeros(3), max_distance=0.7, max_iterations=0, trim=trim)
    assert at_the_guess.inliers == int(np.ceil(share * len(source))), "the first pairs are trimmed as well"


def test_at_least_one_pair_stays():
    source, target = with_box(1)
    found = icp(source, target, np.zeros(3), max_distance=0.7, trim=1.0, min_pairs=1)
    assert found.inliers == 1, f"{found.inliers} pairs are kept, expected 1"


def test_too_few_pairs_end_it_at_the_guess():
    source, target = with_box(1)
    away = np.array([50.0, 0.0, 0.0])
    found = icp(source, target, away, max_distance=0.7, trim=0.25)
    assert_same_pose(found.pose, away, 1e-15)
    assert (found.inliers, len(found.trace), found.rmse) == (0, 1, np.inf)
    few = icp(source[:7], target, np.zeros(3), max_distance=0.7)
    assert len(few.trace) == 1, "7 pairs are fewer than min_pairs"
    enough = icp(source[:8], target, np.zeros(3), max_distance=0.7)
    assert len(enough.trace) > 1, "8 pairs are min_pairs"


@pytest.mark.parametrize("variant", ["point-to-point", "point-to-plane"])
def test_it_has_converged_only_where_its_pairs_measure_the_pose(variant):
    _, target = with_box(1)
    source = rs.transform((0.02, 0.03, 0.01), target)
    normals = rs.normals(target)
    guess = np.zeros(3)
    settings = {"variant": variant, "max_distance": 0.7, "max_iterations": 100}
    assert icp(source, target, guess, normals=normals, **settings).converged, "all points have their pairs"
    away = icp(source, target, (50.0, 0.0, 0.0), normals=normals, **settings)
    assert not away.converged, "there is no pair, and converged is true"
    early = icp(source, target, guess, normals=normals, **{**settings, "max_iterations": 1})
    assert not early.converged, "the last increment is large, and converged is true"
    if variant == "point-to-plane":
        for known in (0, 15):
            few = np.where(np.cumsum(~np.isnan(normals[:, :1]), axis=0) > known, np.nan, normals)
            found = icp(source, target, guess, normals=few, **settings)
            assert not found.converged, f"{known} pairs have a normal at most, and 16 are needed: twice min_pairs"
    else:
        one_place = np.full((20, 2), 0.3)
        assert not icp(one_place, one_place + 0.01, (0, 0, 0), **settings).converged, "coincident points measure no rotation"


def test_a_small_increment_ends_it(clouds):
    source, target, truth = clouds
    guess = rs.compose(truth, (0.1, 0.1, 0.05))
    rough = icp(source, target, guess, max_distance=0.7, tolerance=0.03)
    fine = icp(source, target, guess, max_distance=0.7, tolerance=1e-6)
    core = rs.icp(source, target, init=guess, variant="point-to-point", max_distance=0.7, tolerance=0.03)
    assert len(rough.trace) == core.iterations + 1 < len(fine.trace)


def core_icp(source, target, init, *, normals, max_distance, max_iterations):
    request = {"max_distance": max_distance, "max_iterations": max_iterations}
    return rs.icp(source, target, init=init, variant="point-to-point", **request)


def test_it_drives_the_lap():
    theirs, ours = (rs.simulate(icp=function).slam.poses[-1] for function in (icp, core_icp))
    # 1 mm: a point at the edge of a cell may fall into the other one.
    assert_same_pose(theirs, ours, 1e-3, "the last keyframe of the lap")
