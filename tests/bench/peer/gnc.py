"""Graduated non-convexity beside GTSAM's, on recorded graphs with false loops added.

    pip install gtsam
    cargo build --release -p slam2d
    python3 tests/bench/peer/gnc.py ../shared/data/graphs/{intel,csail,m3500,ring}.g2o

Each graph gets 10, 30 and 50 % of its loops once more as false ones, by five seeds: two poses
anywhere are said to be one place (0.3 m and 10° of noise), with the information of a right loop.
The error is the RMS distance of the poses from those without false loops, solved by least squares.
Both solve from the odometry, believe it, and take the 99 % quantile for the largest error of a loop.
Times are CPU time: of ours by its own clock, of GTSAM's by process_time around optimize().
"""

import argparse
import json
import math
import random
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import gtsam

SHARES = (0.1, 0.3, 0.5)
SEEDS = range(1, 6)


def read(path):
    """Vertices by id and edges of a g2o file."""
    vertices, edges = {}, []
    for line in Path(path).read_text().splitlines():
        words = line.split()
        if words[:1] == ["VERTEX_SE2"]:
            vertices[int(words[1])] = [float(w) for w in words[2:5]]
        elif words[:1] == ["EDGE_SE2"]:
            edges.append((int(words[1]), int(words[2]), [float(w) for w in words[3:12]]))
    return vertices, edges


def write(path, vertices, edges):
    lines = [f"VERTEX_SE2 {k} {x!r} {y!r} {t!r}" for k, (x, y, t) in vertices.items()]
    lines += [f"EDGE_SE2 {i} {j} " + " ".join(repr(v) for v in edge) for i, j, edge in edges]
    Path(path).write_text("\n".join(lines) + "\n")


def is_sequential(edge):
    return abs(edge[0] - edge[1]) == 1


def with_false_loops(vertices, edges, share, seed):
    rng = random.Random(seed)
    loops = [edge for edge in edges if not is_sequential(edge)]
    ids = list(vertices)
    false = []
    while len(false) < round(share * len(loops)):
        i, j = sorted(rng.sample(ids, 2))
        if j - i < 2:
            continue
        claim = [rng.gauss(0, 0.3), rng.gauss(0, 0.3), rng.gauss(0, math.radians(10))]
        false.append((i, j, claim + rng.choice(loops)[2][3:]))
    return edges + false


def odometry(vertices, edges):
    """The poses to which the sequential measurements lead."""
    steps = {}
    for edge in edges:
        if is_sequential(edge) and edge[0] < edge[1]:
            steps.setdefault(edge[0], gtsam.Pose2(*edge[2][:3]))
    ids = sorted(vertices)
    poses = {ids[0]: gtsam.Pose2(*vertices[ids[0]])}
    for k in ids[:-1]:
        poses[k + 1] = poses[k].compose(steps[k])
    return {k: [p.x(), p.y(), p.theta()] for k, p in poses.items()}


def rms_m(a, b):
    squares = [(a[k][0] - b[k][0]) ** 2 + (a[k][1] - b[k][1]) ** 2 for k in a]
    return math.sqrt(sum(squares) / len(squares))


def ours(slam2d, folder, name, *arguments):
    out = folder / "solved.g2o"
    command = [slam2d, "optimize", str(name), "-o", str(out), "--json", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return read(out)[0], json.loads(done.stdout)["cpu_ms_first"]


def gtsams(vertices, edges):
    graph, known, values = gtsam.NonlinearFactorGraph(), [], gtsam.Values()
    for i, j, (x, y, t, a, b, c, d, e, f) in edges:
        information = [[a, b, c], [b, d, e], [c, e, f]]
        noise = gtsam.noiseModel.Gaussian.Information(information)
        if is_sequential((i, j)):
            known.append(graph.size())
        graph.add(gtsam.BetweenFactorPose2(i, j, gtsam.Pose2(x, y, t), noise))
    first = min(vertices)
    known.append(graph.size())
    prior = gtsam.noiseModel.Isotropic.Sigma(3, 1e-6)
    graph.add(gtsam.PriorFactorPose2(first, gtsam.Pose2(*vertices[first]), prior))
    for k, pose in vertices.items():
        values.insert(k, gtsam.Pose2(*pose))
    parameters = gtsam.GncLMParams(gtsam.LevenbergMarquardtParams())
    parameters.setKnownInliers(known)
    parameters.setLossType(gtsam.GncLossType.TLS)
    optimizer = gtsam.GncLMOptimizer(graph, values, parameters)
    optimizer.setInlierCostThresholdsAtProbability(0.99)
    start = time.process_time()
    solved = optimizer.optimize()
    elapsed_ms = 1e3 * (time.process_time() - start)
    poses = {k: solved.atPose2(k) for k in vertices}
    return {k: [p.x(), p.y(), p.theta()] for k, p in poses.items()}, elapsed_ms


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("graphs", nargs="+")
    arguments.add_argument("--slam2d", default="target/release/slam2d")
    arguments.add_argument("--methods", default="gnc,gnc-gm,pcm")
    arguments.add_argument("--without-gtsam", action="store_true")
    arguments = arguments.parse_args()
    methods = arguments.methods.split(",")
    print(f"{'graph':<8} {'false':>5}  {'who':<7} {'median m':>9} {'worst m':>9} {'median ms':>10}")
    for path in arguments.graphs:
        vertices, edges = read(path)
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            clean, _ = ours(arguments.slam2d, folder, path)
            for share in SHARES:
                results = {}
                for seed in SEEDS:
                    spoilt = with_false_loops(vertices, edges, share, seed)
                    start = odometry(vertices, edges)
                    write(folder / "spoilt.g2o", start, spoilt)
                    solvers = {
                        method: lambda m=method: ours(
                            arguments.slam2d, folder, folder / "spoilt.g2o", "--robust", m
                        )
                        for method in methods
                    }
                    if not arguments.without_gtsam:
                        solvers["gtsam"] = lambda: gtsams(start, spoilt)
                    for who, solve in solvers.items():
                        poses, ms = solve()
                        results.setdefault(who, []).append((rms_m(poses, clean), ms))
                for who, runs in results.items():
                    errors, times = [r[0] for r in runs], [r[1] for r in runs]
                    print(
                        f"{Path(path).stem:<8} {100 * share:>4.0f}%  {who:<7} "
                        f"{statistics.median(errors):>9.4f} {max(errors):>9.4f} "
                        f"{statistics.median(times):>10.1f}",
                        flush=True,
                    )


if __name__ == "__main__":
    main()
