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


def rows(file):
    """The rows that a file holds, without its header."""
    return file.read_text().splitlines()[1:] if file.exists() else []


def kill_a_worker_at_work(cluster, folder, killed):
    """Kills the process of a worker once there is a row, and so in the middle of a shard."""
    while not any(rows(file) for file in folder.glob("*.jsonl")):
        threading.Event().wait(0.01)
    worker = next(iter(cluster.workers.values()))
    killed.append({file.name: len(rows(file)) for file in folder.glob("*.jsonl")})
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
        assert killed and sum(killed[0].values()) > 0, "no worker was killed at work"
        # A row that was there at the kill was kept: no lap was driven twice.
        count = sum(len(rows(file)) for file in files)
        assert count == 48, f"{count} rows for 48 laps"
    print(f"the same figures as one process; killed at {killed[0]}")


if __name__ == "__main__":
    main(sys.argv[1])
