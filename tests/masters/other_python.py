"""Jobs in an importer that has a Python of its own: a job a line on the standard input of its process, as JSON with the file
for its rows.

An empty line is the answer when they are there, and what went wrong if they are not.
"""

import contextlib
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np


class OtherPython:
    """One process for all jobs: it takes seconds to start."""

    def __init__(self, python, script, package):
        # An interpreter's link is what makes its environment: it is not followed.
        python = Path(python).absolute()
        told = f"from importlib.metadata import version; print(version('{package}'), end='')"
        self.version = subprocess.run([python, "-c", told], check=True, capture_output=True, text=True).stdout
        self.folder = tempfile.TemporaryDirectory()
        script = Path(__file__).with_name(script)
        # Some importers write logs to where they are.
        self.process = subprocess.Popen([python, script], cwd=self.folder.name, stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, bufsize=1)

    def run(self, job):
        """The rows of a job."""
        rows = Path(self.folder.name) / "rows.npy"
        print(json.dumps(job | {"rows": str(rows)}), file=self.process.stdin)
        answer = self.process.stdout.readline()
        assert answer == "\n", answer or "it has ended"
        return np.load(rows)


def serve(run):
    """The other side: runs jobs until there are no more."""
    for line in sys.stdin:
        job, answer = json.loads(line), ""
        # Importers report on standard output.
        with contextlib.redirect_stdout(sys.stderr):
            try:
                np.save(job["rows"], run(job))
            except Exception as error:
                answer = repr(error).replace("\n", " ")
        print(answer, flush=True)
