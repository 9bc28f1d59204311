"""Executes a notebook as a student does, from top to bottom.

    python notebook.py NOTEBOOK OUT [NAME=VALUE …]

Fails if a cell does, or if the file holds outputs: what it shows is made when it is run. NAME=VALUE is set in the
notebook's environment. The executed notebook goes to OUT, to be looked at.
"""

import os
import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient


def main():
    path, out = Path(sys.argv[1]), Path(sys.argv[2])
    os.environ.update(assignment.split("=", 1) for assignment in sys.argv[3:])
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not any(cell.outputs or cell.execution_count for cell in code), f"clear the outputs of {path}"
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": path.parent}}).execute()
    out.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, out)
    for cell in code:
        for output in cell.outputs:
            print(output.get("text", ""), end="")


if __name__ == "__main__":
    main()
