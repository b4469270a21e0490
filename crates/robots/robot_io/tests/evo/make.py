"""Writes the trajectories, and the values of evo that the tests compare with.

    ch16 lap --seed 7 --world ring --json > lap.json
    pip install evo==1.38.1
    python crates/robots/robot_io/tests/evo/make.py lap.json

The truth has every tick of the lap. The estimate lacks every seventh, and its clock is 4 ms late,
so stamps must be associated.
"""

import json
import sys
from math import cos, sin
from pathlib import Path

from evo.core import metrics, sync
from evo.core.trajectory import PoseTrajectory3D
from evo.tools import file_interface

FOLDER = Path(__file__).parent


def write(name, ticks, delay_s):
    with open(FOLDER / name, "w", encoding="utf-8") as file:
        for tick, (x, y, theta) in ticks:
            stamp = 1000 + 0.25 * tick + delay_s
            quaternion = f"0 0 {sin(theta / 2):.9f} {cos(theta / 2):.9f}"
            print(f"{stamp:.3f} {x:.6f} {y:.6f} 0 {quaternion}", file=file)


def statistics(metric, pair):
    metric.process_data(pair)
    return metric.get_all_statistics()


def values(truth: PoseTrajectory3D, estimate: PoseTrajectory3D, align: bool):
    truth, estimate = sync.associate_trajectories(truth, estimate)
    if align:
        estimate.align(truth)
    pair = (truth, estimate)
    relation = metrics.PoseRelation
    return {
        "n": estimate.num_poses,
        "ate": statistics(metrics.APE(relation.translation_part), pair),
        "rpe": {
            "trans": statistics(metrics.RPE(relation.translation_part), pair),
            "rot_deg": statistics(metrics.RPE(relation.rotation_angle_deg), pair),
        },
    }


def main():
    lap = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    ticks = list(enumerate(lap["per_tick"]))
    write("truth.tum", [(k, tick["truth"]) for k, tick in ticks], 0.0)
    seen = [(k, tick["estimate"]) for k, tick in ticks if k % 7]
    write("estimate.tum", seen, 0.004)
    read = file_interface.read_tum_trajectory_file
    found = {
        name: values(read(FOLDER / "truth.tum"), read(FOLDER / "estimate.tum"), name == "se2")
        for name in ("none", "se2")
    }
    text = json.dumps(found, indent=1)
    (FOLDER / "values.json").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
