"""rustslam2d beside the packages that one would pick instead: the same clouds and graphs, one run, one machine.

    pip install rustslam2d small_gicp kiss-icp open3d gtsam scipy
    python crates/robots/slam2d_py/bench/peers.py [GRAPH.g2o …] [--write docs/python.md]

A package that is not installed is named and left out. Every call takes arrays of numpy and gives one back, on one thread.
A time is the median of repeated calls in CPU time of the process, and the packages take turns, so that a busy machine is
as busy for each.
"""

import argparse
import importlib
import os
import platform
import statistics
import sys
import tempfile
import time
from pathlib import Path

# Before numpy and the peers start their threads.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import numpy as np
import rustslam2d as rs

#: The largest distance of a pair, m.
REACH = 0.5
#: Rounds in which each peer is called once.
ROUNDS = 41


def module(name):
    """A peer, if it is installed."""
    try:
        return importlib.import_module(name)
    except Exception as why:  # Some fail at a library that they need.
        print(f"{name} is left out: {why}", file=sys.stderr)
        return None


PEERS = {name: module(name) for name in ("small_gicp", "kiss_icp", "open3d", "gtsam", "scipy.spatial")}


def clouds():
    """Scans of the lap on the ten scans before them: target, source, truth, guess."""
    drive = rs.simulate(seed=16)
    points = [drive.sensor.points(ranges) for ranges in drive.ranges]
    scenes = []
    for new in range(20, len(drive), 6):
        old = range(new - 10, new)
        target = np.concatenate([rs.transform(rs.between(drive.truth[new - 10], drive.truth[k]), points[k]) for k in old])
        truth = rs.between(drive.truth[new - 10], drive.truth[new])
        scenes.append((target, points[new], truth, rs.compose(truth, (0.05, -0.04, 0.03))))
    return scenes


def space(points):
    return np.column_stack([points, np.zeros(len(points))])


def matrix(pose):
    x, y, theta = pose
    made = np.eye(4)
    made[:2, :2] = [[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]]
    made[:2, 3] = x, y
    return made


def planar(made):
    return np.array([made[0, 3], made[1, 3], np.arctan2(made[1, 0], made[0, 0])])


def by_rustslam2d(variant):
    return lambda target, source, guess: rs.icp(source, target, init=guess, variant=variant, max_distance=REACH).pose


def by_small_gicp(target, source, guess):
    found = PEERS["small_gicp"].align(
        space(target), space(source), init_T_target_source=matrix(guess), registration_type="ICP",
        downsampling_resolution=0.02, max_correspondence_distance=REACH, num_threads=1,
    )
    return planar(found.T_target_source)


def by_kiss_icp(target, source, guess):
    mapping = importlib.import_module("kiss_icp.mapping")
    registration = importlib.import_module("kiss_icp.registration").Registration(25, 1e-4, 1)
    voxels = mapping.VoxelHashMap(voxel_size=REACH, max_distance=100.0, max_points_per_voxel=60)
    voxels.add_points(space(target))
    return planar(registration.align_points_to_map(space(source), voxels, matrix(guess), REACH, REACH))


def by_open3d(target, source, guess):
    open3d = PEERS["open3d"]
    cloud = lambda points: open3d.geometry.PointCloud(open3d.utility.Vector3dVector(space(points)))
    icp = open3d.pipelines.registration
    found = icp.registration_icp(cloud(source), cloud(target), REACH, matrix(guess),
                                 icp.TransformationEstimationPointToPoint(), icp.ICPConvergenceCriteria(1e-6, 1e-6, 25))
    return planar(found.transformation)


def by_scipy(target, source, guess):
    """What one writes in ten lines: a k-d tree, a singular value decomposition, and again."""
    tree = PEERS["scipy.spatial"].cKDTree(target)
    rotation, shift = matrix(guess)[:2, :2], np.array(guess[:2])
    for _ in range(25):
        moved = source @ rotation.T + shift
        distance, index = tree.query(moved, distance_upper_bound=REACH)
        near = np.isfinite(distance)
        p, q = moved[near], target[index[near]]
        u, _, vt = np.linalg.svd((p - p.mean(0)).T @ (q - q.mean(0)))
        turn = vt.T @ np.diag([1, np.linalg.det(vt.T @ u.T)]) @ u.T
        rotation, shift = turn @ rotation, turn @ (shift - p.mean(0)) + q.mean(0)
        if np.hypot(*(moved @ turn.T - turn @ p.mean(0) + q.mean(0) - moved).T).max() < 1e-4:
            break
    return np.array([*shift, np.arctan2(rotation[1, 0], rotation[0, 0])])


def milliseconds(call):
    began = time.process_time()
    result = call()
    return 1e3 * (time.process_time() - began), result


def compare(calls, rounds):
    """The median time (ms) of each call, taking turns, and its last result."""
    times, results = {name: [] for name in calls}, {}
    for _ in range(rounds):
        for name, call in calls.items():
            took, results[name] = milliseconds(call)
            times[name].append(took)
    return {name: statistics.median(took) for name, took in times.items()}, results


def registration_rows():
    contenders = {
        "rustslam2d, point-to-point": by_rustslam2d("point-to-point"),
        "small_gicp, ICP": PEERS["small_gicp"] and by_small_gicp,
        "kiss-icp": PEERS["kiss_icp"] and by_kiss_icp,
        "open3d, point-to-point": PEERS["open3d"] and by_open3d,
        "scipy, k-d tree and SVD": PEERS["scipy.spatial"] and by_scipy,
        "rustslam2d, point-to-plane": by_rustslam2d("point-to-plane"),
    }
    contenders = {name: register for name, register in contenders.items() if register}
    scenes = clouds()
    every = {
        name: (lambda register=register: [register(target, source, guess) for target, source, _, guess in scenes])
        for name, register in contenders.items()
    }
    times, found = compare(every, ROUNDS)
    base = times["rustslam2d, point-to-point"]
    for name, poses in found.items():
        off = [1e3 * np.hypot(*(pose - truth)[:2]) for pose, (_, _, truth, _) in zip(poses, scenes)]
        yield name, 1e3 * times[name] / len(scenes), times[name] / base, f"{statistics.median(off):.1f} mm"


def by_gtsam(path):
    gtsam = PEERS["gtsam"]
    # It reads up to the first record that it does not know.
    known = [line for line in path.read_text().splitlines(keepends=True) if not line.startswith("FIX")]
    with tempfile.NamedTemporaryFile("w", suffix=".g2o") as file:
        file.writelines(known)
        file.flush()
        graph, initial = gtsam.readG2o(file.name, False)
    first = min(initial.keys())
    graph.add(gtsam.PriorFactorPose2(first, initial.atPose2(first), gtsam.noiseModel.Diagonal.Sigmas(np.full(3, 1e-6))))

    def solve():
        result = gtsam.GaussNewtonOptimizer(graph, initial).optimize()
        return 2 * graph.error(result)

    return solve


def graph_rows(paths):
    for path in paths:
        text = path.read_text()
        read = rs.PoseGraph.read_g2o(path)
        given = read.poses

        def ours():
            read.poses = given
            return read.optimize(start="given").chi2

        calls = {"rustslam2d": ours}
        if PEERS["gtsam"]:
            calls["gtsam, Gauss–Newton"] = by_gtsam(path)
        times, chi2 = compare(calls, 9)
        for name in calls:
            yield path.stem, text.count("EDGE_SE2"), name, times[name], times[name] / times["rustslam2d"], chi2[name]


def lap_graph(folder):
    """The graph of the chapter's lap, for whoever has no recorded one."""
    drive = rs.simulate()
    slam = rs.Slam.chapter(sensor=drive.sensor, start=drive.truth[0])
    for frame in zip(drive.ranges, drive.odometry, drive.stamps):
        slam.step(*frame)
    path = Path(folder) / "lap.g2o"
    slam.graph.write_g2o(path)
    return path


def processor():
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def tables(graphs):
    from importlib.metadata import PackageNotFoundError, version

    packages = {"small_gicp": "small_gicp", "kiss_icp": "kiss-icp", "open3d": "open3d", "gtsam": "gtsam", "scipy.spatial": "scipy"}
    there, absent = [], []
    for name, package in packages.items():
        if PEERS[name]:
            try:
                there.append(f"{package} {version(package)}")
            except PackageNotFoundError:
                there.append(package)
        else:
            absent.append(package)
    yield f"{processor()}, Python {platform.python_version()}, numpy {np.__version__}; {', '.join(there)}."
    if absent:
        yield f"Not installed, and so left out: {', '.join(absent)}."
    yield ""
    yield "| registration | median of a call | ratio | off the truth |"
    yield "| --- | ---: | ---: | ---: |"
    for name, microseconds, ratio, off in registration_rows():
        yield f"| {name} | {microseconds:.0f} µs | {ratio:.1f} | {off} |"
    yield ""
    yield "| graph | edges | solver | median | ratio | χ² |"
    yield "| --- | ---: | --- | ---: | ---: | ---: |"
    for graph, edges, solver, took, ratio, chi2 in graph_rows(graphs):
        yield f"| {graph} | {edges:,} | {solver} | {took:.2f} ms | {ratio:.1f} | {chi2:.4f} |"


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("graphs", nargs="*", type=Path, help="recorded pose graphs besides that of the lap")
    arguments.add_argument("--write", type=Path, help="a page whose block between the marks `peers` is replaced")
    given = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        text = "\n".join(tables([lap_graph(folder), *given.graphs]))
    print(text)
    if given.write:
        page = given.write.read_text("utf-8")
        begin, end = "<!-- peers -->\n", "\n<!-- /peers -->"
        head, rest = page.split(begin)
        given.write.write_text(head + begin + text + end + rest.split(end)[1], "utf-8")


if __name__ == "__main__":
    main()
