"""The exercises in Python: how far you are, what comes next, and a hint.

    python -m rustslam2d.exercises                 in the folder teaching/exercises/python
    python -m rustslam2d.exercises --plan lab      the next one in the order of the lab
    python -m rustslam2d.exercises --json          one object for a grader
    python -m rustslam2d.exercises --lap           your functions drive the chapter's lap
    python -m rustslam2d.exercises --log FILE      they map a robot's log, into map.yaml

Each exercise is tested by pytest in a process without your code, which runs in another one and answers calls. So your code
can return wrong values, or end; it cannot reach the tests, and what it prints or writes is ignored.
"""

import argparse
import json
import os
import secrets
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from ._apart import TESTS

HINTS = {
    "svd_align": "Subtract both means first; then only a rotation is left to find, and t follows from the means.",
    "point_to_plane_step": "numpy.column_stack makes the rows. Add the ridge, solve, and turn about the centroid.",
    "residual": "Z⁻¹ comes first in the product; the rotation part of Ad is the pose's.",
    "gauss_newton": "Each edge adds four 3×3 blocks and two 3-vectors; skip the held pose's.",
    "verify_loop": "The belief is in the candidate's frame: between(poses[candidate], poses[node]).",
    "trimmed_icp": "Trim after each association, the first one too. Count what is kept with ceil, and keep at least one.",
    "range_histogram": "A bin is the range times 64/max_range, rounded down, 63 at most. Skip bins that are empty in both.",
}

#: Orders in which to solve them: teaching/guide/lectures.md has the lab, with two for homework at the end.
PLANS = {
    "list": list(HINTS),
    "lab": ["svd_align", "trimmed_icp", "residual", "gauss_newton", "verify_loop", "point_to_plane_step", "range_histogram"],
}

#: An endless loop is ended after this time, s.
LIMIT_S = 120
#: Time for the tests besides, s.
START_S = 120


def folder_of(given):
    """The folder of the exercises; ends with a sentence if there is none."""
    for folder in [Path(given)] if given else [Path(), Path("teaching/exercises/python")]:
        if (folder / "tests/test_svd_align.py").is_file():
            return folder.resolve()
    sys.exit(f"{given or Path().resolve()} is not the folder teaching/exercises/python; go there, or name it with --folder")


def run(name, folder, code):
    """The tests of one exercise: (names with their results, the first failure), or (None, why they did not run)."""
    with tempfile.TemporaryDirectory() as place:
        tested, student = Path(place, "tested"), Path(place, "student")
        shutil.copytree(folder / "tests", tested / "tests", ignore=shutil.ignore_patterns("__pycache__"))
        student.mkdir()
        for side in (tested, student):
            shutil.copy(folder / "given.py", side)
        # The seven files and no other: a module beside them could stand for one of ours.
        for one in HINTS:
            if (code / f"{one}.py").is_file():
                shutil.copy(code / f"{one}.py", student)
            proxy = f"from rustslam2d._apart import function\n\n\ndef __getattr__(name):\n    return function({one!r}, name)\n"
            Path(tested, f"{one}.py").write_text(proxy, "utf-8")
        key = secrets.token_hex(32)
        environment = {name: value for name, value in os.environ.items() if name != "EXERCISES"}
        # The key comes by the standard input, before the student's process starts.
        order = json.dumps({"key": key, "student": str(student), "limit_s": LIMIT_S, "test": f"tests/test_{name}.py"})
        try:
            done = subprocess.run(
                [sys.executable, "-B", "-c", TESTS],
                cwd=tested, env=environment, input=order, capture_output=True, text=True, encoding="utf-8",
                timeout=LIMIT_S + START_S,
            )
        except subprocess.TimeoutExpired:
            return None, f"it was ended after {LIMIT_S + START_S} s; is there an infinite loop?"
        signed = [line[len(key):] for line in done.stdout.splitlines() if line.startswith(key)]
        if len(signed) != 1:
            text = (done.stdout + done.stderr).strip()
            return None, "\n".join(text.splitlines()[-12:]) or "the process of the tests ended before they did"
        report = json.loads(signed[0])
        return report["results"] or None, report["message"]


def state(name, folder, results):
    """passes, fails or not written."""
    if results and all(results.values()):
        return "passes"
    source = folder / f"{name}.py"
    untouched = source.is_file() and "raise NotImplementedError(" in source.read_text("utf-8")
    return "not written" if untouched else "fails"


def waits(name, result):
    """The unwritten exercise without which the only failures of this one are, or None."""
    results, message = result
    if not results or not message:
        return None
    # One test passes, so the function itself is written.
    others = [other for other in HINTS if other != name and f"{other} is not written yet" in message]
    return others[0] if others and any(results.values()) else None


def written(folder, tried):
    """The student's ICP and gate; the gate notes in `tried` what it was asked."""
    sys.path[:0] = [str(folder)]
    from trimmed_icp import icp
    from verify_loop import verify_loop

    def gate(poses, sweeps, node, candidate):
        found = verify_loop(poses, sweeps, node, candidate)
        tried.append((node, candidate, found))
        return found

    return icp, gate


def map_log(folder, log):
    """Maps a log with the student's ICP and gate."""
    import rustslam2d as rs

    tried = []
    icp, gate = written(folder, tried)
    sensor, frames = rs.Pipeline(log).frames()
    slam = rs.Slam.chapter(sensor=sensor, icp=icp, gate=gate)
    for frame in frames:
        slam.step(*frame)
    slam.map(0.1).save("map.yaml")
    print(f"{slam}, {sum(found.accepted for _, _, found in tried)} of {len(tried)} loops accepted: map.yaml, map.pgm")


def lap(folder):
    """Drives the chapter's lap with the functions that are written."""
    import numpy as np

    import rustslam2d as rs

    tried = []
    icp, gate = written(folder, tried)
    for what, functions in (("ours", {}), ("your ICP", {"icp": icp}), ("your ICP and gate", {"icp": icp, "gate": gate})):
        try:
            drive = rs.simulate(icp=functions.get("icp", core_icp), gate=functions.get("gate"))
        except NotImplementedError as error:
            print(f"{what}: {error}")
            continue
        poses = drive.slam.poses
        errors = np.hypot(*(poses - drive.truth[drive.slam.keyframes])[:, :2].T)
        print(f"{what:<18} rms error {np.sqrt(np.mean(errors**2)):.3f} m, {len(drive.slam.graph.edges) - len(poses) + 1} loops")
    for node, candidate, found in tried:
        verdict = "accepted" if found.accepted else "rejected"
        print(f"  {node} to {candidate}: χ² {found.chi2:.3f}, rmse {found.rmse:.3f} m, {found.inliers} pairs: {verdict}")


def core_icp(source, target, init, *, normals, max_distance, max_iterations):
    """The registration of the core."""
    import rustslam2d as rs

    settings = {"variant": "point-to-point", "max_distance": max_distance, "max_iterations": max_iterations}
    return rs.icp(source, target, init=init, **settings)


def show(states, found, plan):
    """A list, a bar, and the next exercise of the plan with its hint."""
    for name, (results, _) in found.items():
        passed = sum((results or {}).values())
        other = waits(name, found[name])
        what = f"waits for {other}" if other else states[name]
        print(f"  {name:<20}  {passed} of {len(results or {})} tests  {what}")
    done = sum(one == "passes" for one in states.values())
    print(f"\n{'█' * (4 * done)}{'░' * (4 * (len(states) - done))}  {done} of {len(states)} exercises")
    left = [name for name in PLANS[plan] if states.get(name, "passes") != "passes"]
    following = next((name for name in left if not waits(name, found[name])), None)
    if following is None:
        print("\nSee them drive: python -m rustslam2d.exercises --lap")
        return
    print(f"\nNext: {following}.py\nHint: {HINTS[following]}\nRun:  python -m pytest tests/test_{following}.py")
    if found[following][1]:
        message = found[following][1].replace("\n", "\n  ")
        print(f"\n{message}")


def main(arguments=None):
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m rustslam2d.exercises", description=__doc__.splitlines()[0])
    parser.add_argument("--folder", help="the folder with the seven files and tests/")
    parser.add_argument("--code", help="mark the functions in this folder instead, with the tests of --folder")
    parser.add_argument("--plan", choices=PLANS, default="list", help="the order in which the next one is named")
    parser.add_argument("--json", action="store_true", help="print one object for a grader")
    parser.add_argument("--lap", action="store_true", help="drive the chapter's lap with your functions")
    parser.add_argument("--log", metavar="FILE", help="map a robot's log with your functions, into map.yaml")
    chosen = parser.parse_args(arguments)
    folder = folder_of(chosen.folder)
    code = Path(chosen.code).resolve() if chosen.code else folder
    if chosen.lap or chosen.log:
        sys.path.append(str(folder))
        return map_log(code, chosen.log) if chosen.log else lap(code)
    found = {name: run(name, folder, code) for name in HINTS}
    states = {name: state(name, code, results) for name, (results, _) in found.items()}
    if not chosen.json:
        return show(states, found, chosen.plan)
    exercises = [
        {
            "name": name,
            "state": states[name],
            "tests": [{"name": test, "passed": passed} for test, passed in (results or {}).items()],
            "message": message,
        }
        for name, (results, message) in found.items()
    ]
    passed = sum(one == "passes" for one in states.values())
    print(json.dumps({"schema": 1, "ran": True, "passed": passed, "total": len(HINTS), "exercises": exercises}))


if __name__ == "__main__":
    main()
