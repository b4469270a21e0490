"""The exercises in Python: solutions pass, untouched stubs fail, and printing earns nothing."""

import json
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT
from rustslam2d import exercises

FOLDER = ROOT / "teaching/exercises/python"


def report(capsys, *arguments):
    exercises.main(["--folder", str(FOLDER), "--json", *arguments])
    return json.loads(capsys.readouterr().out)


def test_the_solutions_pass_and_untouched_stubs_fail(capsys):
    solved = report(capsys, "--code", str(FOLDER / "solutions"))
    assert solved["passed"] == solved["total"] == 7, [one for one in solved["exercises"] if one["state"] != "passes"]
    untouched = report(capsys)
    assert [one["name"] for one in untouched["exercises"]] == list(exercises.HINTS)
    for one in untouched["exercises"]:
        assert one["state"] == "not written" and one["tests"], one
        assert not any(test["passed"] for test in one["tests"]), one
        assert "is not written yet: its task is in" in one["message"], one


@pytest.fixture
def code(tmp_path):
    folder = tmp_path / "code"
    shutil.copytree(FOLDER / "solutions", folder)
    return folder


@pytest.mark.parametrize(
    "added",
    [
        'print("test_no_pairs_give_the_identity PASSED")\nraise ValueError("no")',
        "import os; os._exit(0)",
        "import sys; sys.exit(0)",
        "def (:",
    ],
)
def test_what_a_file_prints_or_how_it_exits_earns_nothing(code, added):
    file = code / "svd_align.py"
    file.write_text(file.read_text() + "\n" + added)
    results, message = exercises.run("svd_align", FOLDER, code)
    assert not (results and all(results.values())) and message
    assert exercises.state("svd_align", code, results) == "fails"


def test_the_next_one_is_that_of_the_plan_and_what_waits_is_passed_over(capsys, code):
    for name in ("point_to_plane_step", "range_histogram", "residual"):
        shutil.copy(FOLDER / f"{name}.py", code)
    found = {name: exercises.run(name, FOLDER, code) for name in ("svd_align", "residual", "trimmed_icp")}
    assert exercises.waits("trimmed_icp", found["trimmed_icp"]) == "point_to_plane_step"
    states = {name: exercises.state(name, code, results) for name, (results, _) in found.items()}
    for plan, following in (("list", "residual"), ("lab", "residual")):
        exercises.show(states, found, plan)
        assert f"Next: {following}.py" in capsys.readouterr().out
    assert exercises.PLANS["lab"][1] == "trimmed_icp" and set(exercises.PLANS["lab"]) == set(exercises.HINTS)


def test_the_solutions_map_a_log(drive, tmp_path):
    drive.write_log(tmp_path / "lap.jsonl")
    command = [sys.executable, "-m", "rustslam2d.exercises", "--folder", FOLDER, "--code", FOLDER / "solutions"]
    done = subprocess.run([*command, "--log", "lap.jsonl"], cwd=tmp_path, capture_output=True, text=True)
    assert done.stdout.startswith("Slam(130 scans, "), done.stderr
    assert re.search(r"[1-9]\d* of [1-9]\d* loops accepted: map.yaml, map.pgm\n$", done.stdout), done.stdout
    assert (tmp_path / "map.pgm").read_bytes().startswith(b"P5")


@pytest.mark.parametrize("workflow", ["classroom-ci.yml", "classroom-python-ci.yml"])
def test_the_workflows_give_a_point_for_each_exercise(workflow):
    text = (ROOT / "teaching/guide" / workflow).read_text("utf-8")
    names = list(exercises.HINTS)
    assert sorted(re.findall(r"- id: (\w+)", text)) == sorted(names)
    assert sorted(re.search(r"runners: (.*)", text)[1].split(",")) == sorted(names)
    for name in names:
        command = rf'.name == "{name}") | .state == "passes"'
        assert command in text, name
        assert f"{name.upper()}_RESULTS: ${{{{ steps.{name}.outputs.result }}}}" in text, name
