"""The exercises in Python: solutions pass, untouched stubs fail, and no forgery earns anything."""

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


#: Wrong functions that try to pass: by the report, by pytest, by the tests, by given.py, by a module, by a value.
FORGERIES = {
    "the report named in argv": """
import os, sys
path = next((a.split("=", 1)[1] for a in sys.argv if a.startswith("--junitxml=")), None)
if path: open(path, "w").write('<testsuite><testcase name="test_x"/></testsuite>')
os._exit(0)""",
    "every file and stream in reach": """
import glob, json, os
names = ["test_it_gives_what_the_core_gives"]
line = json.dumps({"results": dict.fromkeys(names, True), "message": None})
for path in glob.glob("/proc/%d/fd/1" % os.getppid()):
    try: open(path, "w").write(line + "\\n")
    except OSError: pass
for fd in range(3, 64):
    try: os.write(fd, line.encode())
    except OSError: pass
print(line)
os._exit(0)""",
    "pytest": """
import _pytest.runner, _pytest.reports, pytest
_pytest.reports.TestReport.passed = property(lambda self: True)
_pytest.runner.runtestprotocol = lambda item, **more: []
def residual(*given): return [0, 0, 0]
def jacobians(z): return [[0] * 3] * 3, [[0] * 3] * 3""",
    "numpy and the core": """
import numpy as np, rustslam2d as rs
np.abs = lambda value: np.zeros(3)
np.ndarray.max = rs.between = lambda *given: np.zeros(3)
def residual(*given): return np.full(3, 9.0)
def jacobians(z): return np.full((3, 3), 9.0), np.full((3, 3), 9.0)""",
    "a value that is equal to all": """
class Equal(float):
    def __eq__(self, other): return True
    def __lt__(self, other): return True
    def __abs__(self): return self
    def __sub__(self, other): return self
def residual(*given): return [Equal(9)] * 3
def jacobians(z): return Equal(9), Equal(9)""",
    "a value that runs code where it is read": """
class Run:
    def __reduce__(self): return exec, ("import os; os._exit(0)",)
def residual(*given): return Run()
def jacobians(z): return Run(), Run()""",
    "importing what passes": "from solved import *",
}


@pytest.mark.parametrize("forgery", FORGERIES)
def test_a_forged_report_fails(code, forgery):
    shutil.copy(code / "residual.py", code / "solved.py")
    (code / "residual.py").write_text(FORGERIES[forgery])
    for name in ("given", "conftest", "sitecustomize", "pytest"):
        (code / f"{name}.py").write_text("import os; os._exit(0)")
    results, message = exercises.run("residual", FOLDER, code)
    assert len(results) == 5 and not all(results.values()) and message, results


def test_a_loop_without_end_is_ended(code, monkeypatch):
    (code / "svd_align.py").write_text("def svd_align(src, dst):\n    while True:\n        pass\n")
    monkeypatch.setattr(exercises, "LIMIT_S", 5)
    results, message = exercises.run("svd_align", FOLDER, code)
    assert len(results) == 6 and not any(results.values())
    assert "it was ended after 5 s; is there an infinite loop?" in message


def test_an_argument_that_the_code_changes_is_changed_for_the_test(code):
    text = (code / "gauss_newton.py").read_text("utf-8")
    (code / "gauss_newton.py").write_text(text.replace("def optimize(", "def kept(", 1) + """

def optimize(poses, *others):
    found = kept(poses, *others)
    poses += 1.0
    return found
""")
    results, message = exercises.run("gauss_newton", FOLDER, code)
    assert "must not change" in message, message


@pytest.mark.parametrize(
    ("name", "place", "instead", "told"),
    [
        ("range_histogram", "BINS - 1).astype", "BINS).astype", "counts in the last bin, 63"),
        ("residual", "rs.compose(rs.inverse(from_), to)", "rs.compose(to, rs.inverse(from_))", "its factors in this order"),
        ("gauss_newton", "rs.compose(pose, rs.exp(step))", "rs.compose(rs.exp(step), pose)", "not exp(δ) T"),
        ("trimmed_icp", "rs.compose(step, pose)", "rs.compose(pose, step)", "not compose(pose, step)"),
    ],
)
def test_the_first_failure_names_the_fault(code, name, place, instead, told):
    text = (code / f"{name}.py").read_text("utf-8")
    assert place in text
    (code / f"{name}.py").write_text(text.replace(place, instead, 1))
    _, message = exercises.run(name, FOLDER, code)
    assert told in message, message


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
