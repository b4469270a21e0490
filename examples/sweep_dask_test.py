"""python examples/sweep_dask_test.py SLAM2D: the sweep on a cluster of two workers, one of which is killed."""

import json
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

from dask.distributed import Client, LocalCluster

sys.path.insert(0, str(Path(__file__).parent))
import sweep_dask

SWEEP = ["--seeds", "1..=48", "--noise", "1"]
SHARDS = 6


def kill_a_worker_at_work(cluster, folder, killed):
    """Kills the process of a worker once there is a part, and so in the middle of the next ones."""
    while not any(folder.glob("*.json")):
        threading.Event().wait(0.01)
    worker = next(iter(cluster.workers.values()))
    killed.extend(file.name for file in folder.glob("*.json"))
    worker.process.process._process.kill()


def main(program):
    whole = subprocess.run([program, "sweep", *SWEEP, "--json"], capture_output=True, text=True, check=True).stdout
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            killed = []
            killer = threading.Thread(target=kill_a_worker_at_work, args=(cluster, folder, killed))
            killer.start()
            files = sweep_dask.sweep(client, program, SWEEP, SHARDS, folder)
            killer.join()
        merge = [program, "sweep", "--merge", *map(str, files), "--json"]
        merged = subprocess.run(merge, capture_output=True, text=True, check=True).stdout
        assert json.loads(merged) == json.loads(whole), "the cluster came to other figures than one process"
        assert 0 < len(killed) < SHARDS, f"a worker was killed when {len(killed)} of {SHARDS} parts were there"
    print(f"the same figures as one process; killed after {killed}")


if __name__ == "__main__":
    main(sys.argv[1])
