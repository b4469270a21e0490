"""The notebooks are kept without outputs, and what they say is asserted; `cargo xtask test python` runs them."""

import importlib.util
import json
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
each = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def code_of(notebook):
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


def grading(cell):
    return cell["metadata"].get("nbgrader", {})


def text_of(cell):
    return "".join(cell["source"])


@each
def test_a_notebook_is_kept_small_and_asserts_what_it_says(path):
    code = code_of(json.loads(path.read_text("utf-8")))
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code)
    # The first one imports; what a reader is to write is asserted by the next.
    assert all("assert " in text_of(cell) for cell in code[1:] if not grading(cell).get("solution"))
    assert path.stat().st_size < 20_000


def test_there_are_four():
    assert [path.name[0] for path in NOTEBOOKS] == ["1", "2", "3", "4"]


@each
def test_each_gap_is_followed_by_its_tests_as_nbgrader_wants_them(path):
    code = code_of(json.loads(path.read_text("utf-8")))
    gaps = [k for k, cell in enumerate(code) if grading(cell).get("solution")]
    assert len(gaps) == 2
    ids = [grading(cell)["grade_id"] for cell in code if grading(cell)]
    assert len(ids) == len(set(ids)) == 4
    for k in gaps:
        gap, tests = grading(code[k]), grading(code[k + 1])
        assert tests["grade_id"] == f"{gap['grade_id']}-tests"
        assert (gap["grade"], gap["locked"], tests["grade"], tests["locked"], tests["solution"]) == (False, False, True, True, False)
        assert tests["points"] == 1 and "points" not in gap
        assert all(one["schema_version"] == 3 and one["task"] is False for one in (gap, tests))


@each
def test_the_version_with_gaps_has_no_solution_and_each_gap_says_so(path):
    spec = importlib.util.spec_from_file_location("gaps", FOLDER / "gaps.py")
    gaps = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(gaps)
    source = json.loads(path.read_text("utf-8"))
    handed_out = gaps.with_gaps(source)
    for solved, open_ in zip(code_of(source), code_of(handed_out)):
        if not grading(solved).get("solution"):
            assert solved == open_
            continue
        assert "### BEGIN SOLUTION" in text_of(solved) and "SOLUTION" not in text_of(open_)
        names = {}
        exec(text_of(open_), {"rs": __import__("rustslam2d"), "target": [[0, 0], [1, 1]], "np": __import__("numpy")}, names)
        function = next(one for one in names.values() if callable(one) and one.__module__ != "numpy")
        with pytest.raises(NotImplementedError):
            function(*[None] * function.__code__.co_argcount)
