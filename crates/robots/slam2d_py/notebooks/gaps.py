"""The notebooks with gaps to fill: python gaps.py FOLDER

The notebooks here have the solutions, between ### BEGIN SOLUTION and ### END SOLUTION, and the cells have the metadata of
nbgrader: `nbgrader generate_assignment` makes the same gaps, and its autograder gives a point for each cell of tests.
"""

import json
import re
import sys
from pathlib import Path

#: What nbgrader writes in place of a solution.
GAP = "# YOUR CODE HERE\n{0}raise NotImplementedError()"


def with_gaps(notebook):
    """A copy of a notebook without its solutions."""
    notebook = json.loads(json.dumps(notebook))
    for cell in notebook["cells"]:
        if cell["metadata"].get("nbgrader", {}).get("solution"):
            text = re.sub(
                r"( *)### BEGIN SOLUTION\n.*?### END SOLUTION",
                lambda found: found[1] + GAP.format(found[1]),
                "".join(cell["source"]),
                flags=re.DOTALL,
            )
            cell["source"] = text.splitlines(keepends=True)
    return notebook


def main(folder):
    """Writes the four into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for path in sorted(Path(__file__).parent.glob("*.ipynb")):
        text = json.dumps(with_gaps(json.loads(path.read_text("utf-8"))), indent=1, ensure_ascii=False)
        (folder / path.name).write_text(f"{text}\n", "utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1])) if len(sys.argv) == 2 else sys.exit(__doc__)
