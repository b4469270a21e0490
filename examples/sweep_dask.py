"""A sweep of laps on a Dask cluster: each task drives one shard, and another worker takes that of a killed one.

    python examples/sweep_dask.py --ch16 target/release/ch16 --output parts -- --seeds 1..=1000 --noise 1

What stands after `--` goes to `ch16 sweep` as it is. `--scheduler ADDRESS` takes a cluster that runs; without it
two workers are started on this machine. The workers need the program and the folder of the parts, at the same paths.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path


def drive(program, options, part, parts, file):
    """Drives one shard, and writes its file at the end."""
    command = [program, "sweep", *options, "--shard", f"{part}/{parts}", "-o", str(file)]
    environment = dict(os.environ)
    threads = [] if "--threads" in options else ["--threads", "1"]
    done = subprocess.run(command + threads, capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip() or f"{program} ended with {done.returncode}")
    return done.stdout.strip()


def sweep(client, program, options, parts, folder, tell=print):
    """Drives all shards on the cluster of `client` and answers with their files."""
    from dask.distributed import as_completed

    folder = Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    files = [folder / f"{part}-of-{parts}.json" for part in range(1, parts + 1)]
    tasks = [
        client.submit(drive, program, options, part, parts, file, pure=False, retries=3)
        for part, file in enumerate(files, start=1)
    ]
    for count, task in enumerate(as_completed(tasks), start=1):
        tell(f"{count} of {parts} shards: {task.result()}", file=sys.stderr)
    return files


def main(arguments):
    own, options = arguments, []
    if "--" in arguments:
        split = arguments.index("--")
        own, options = arguments[:split], arguments[split + 1 :]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ch16", default="ch16", help="the program")
    parser.add_argument("--output", default="parts", help="the folder of the parts")
    parser.add_argument("--shards", type=int, default=8, help="into how many parts the seeds are split")
    parser.add_argument("--scheduler", help="the address of a cluster that runs")
    parser.add_argument("--json", action="store_true", help="print JSON")
    own = parser.parse_args(own)

    try:
        from dask.distributed import Client, LocalCluster
    except ImportError:
        sys.exit("sweep_dask.py needs Dask: pip install 'dask[distributed]'")
    cluster = None if own.scheduler else LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with Client(own.scheduler or cluster) as client:
        files = sweep(client, own.ch16, options, own.shards, own.output)
    if cluster is not None:
        cluster.close()
    merge = [own.ch16, "sweep", "--merge", *map(str, files)] + (["--json"] if own.json else [])
    return subprocess.run(merge).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
