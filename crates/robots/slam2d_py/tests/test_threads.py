"""The interpreter's lock is released while Rust computes."""

import sys
import threading

import numpy as np
import pytest
import rustslam2d as rs

#: A thread that holds the lock calls so often before it gives up on the other one.
MOST_CALLS = 3000


@pytest.fixture
def computations(drive, driven, tmp_path):
    points = np.random.default_rng(0).uniform(-5, 5, (20_000, 2))
    ndt = rs.Ndt(points)
    text = driven[0].graph.to_g2o()
    log = tmp_path / "lap.jsonl"
    drive.write_log(log)

    def slam():
        estimator = rs.Slam.chapter(sensor=drive.sensor)
        for number in range(20):
            estimator.step(drive.ranges[number], drive.odometry[number])

    return {
        "icp": lambda: rs.icp(points, points + 0.1),
        "Ndt": lambda: rs.Ndt(points),
        "Ndt.align": lambda: ndt.align(points),
        "PoseGraph.optimize": lambda: rs.PoseGraph.from_g2o(text).optimize(start="chordal"),
        "PoseGraph.inlier_edges": lambda: rs.PoseGraph.from_g2o(text).inlier_edges(),
        "simulate": rs.simulate,
        "Slam.step": slam,
        "Pipeline.run": lambda: rs.Pipeline(log).run(),
    }


@pytest.mark.parametrize(
    "name",
    ["icp", "Ndt", "Ndt.align", "PoseGraph.optimize", "PoseGraph.inlier_edges", "simulate", "Slam.step", "Pipeline.run"],
)
def test_another_thread_runs_during_a_computation(computations, name):
    compute = computations[name]
    started, seen = threading.Event(), threading.Event()
    calls = []

    def work():
        started.set()
        while not seen.is_set() and len(calls) < MOST_CALLS:
            compute()
            calls.append(1)

    # Nobody is made to give up the lock: the main thread runs only if the worker releases it.
    interval = sys.getswitchinterval()
    worker = threading.Thread(target=work)
    try:
        sys.setswitchinterval(1e6)
        worker.start()
        started.wait()
        seen.set()
        calls_before = len(calls)
        worker.join()
    finally:
        sys.setswitchinterval(interval)
    assert calls_before < MOST_CALLS


def test_two_threads_share_a_graph():
    graph = rs.PoseGraph()

    def work():
        for _ in range(30):
            graph.add_node((0, 0, 0), fixed=True)
            graph.optimize()

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(graph) == 60


def test_a_second_step_is_rejected_and_a_reader_waits(drive):
    inside, over = threading.Event(), threading.Event()

    def icp(source, target, init, **_):
        inside.set()
        assert over.wait(60)
        return init

    slam = rs.Slam.chapter(sensor=drive.sensor, icp=icp)
    slam.step(drive.ranges[0])
    stepping = threading.Thread(target=lambda: slam.step(drive.ranges[1]))
    stepping.start()
    assert inside.wait(60)
    with pytest.raises(rs.SlamError, match="another step of this estimator is under way"):
        slam.step(drive.ranges[2])
    frames = []
    reading = threading.Thread(target=lambda: frames.append(slam.frames))
    reading.start()
    over.set()
    stepping.join()
    reading.join()
    assert frames == [2] and slam.frames == 2
