"""Jobs in cofmupy, run by the Python that has it: a job a line on standard input, as JSON with the file for its rows.

An empty line is the answer when they are there, and what went wrong if they are not.
"""

import contextlib
import json
import sys

import numpy as np
from cofmupy import Coordinator


def unit(end):
    component, variable = end.split(".", 1)
    return {"type": "fmu", "id": component, "variable": variable}


def run(job):
    fmus = [
        {
            "id": name,
            "name": name,
            "path": path,
            "initialization": {
                target.split(".", 1)[1]: value
                for target, value in job["values"].items()
                if target.split(".", 1)[0] == name
            },
        }
        for name, path in job["components"].items()
    ]
    targets = {}
    for source, target in job["connections"]:
        targets.setdefault(source, []).append(unit(target))
    connections = [{"source": unit(source), "target": list(ends)} for source, ends in targets.items()]
    coordinator = Coordinator()
    coordinator.start({"fmus": fmus, "connections": connections})
    for _ in range(job["count"]):
        coordinator.do_step(job["step"])
    results = coordinator.get_results()
    np.save(job["rows"], np.array([results[tuple(signal.split(".", 1))] for signal in job["signals"]]).T)


def main():
    for line in sys.stdin:
        answer = ""
        # It reports on standard output.
        with contextlib.redirect_stdout(sys.stderr):
            try:
                run(json.loads(line))
            except Exception as error:
                answer = repr(error).replace("\n", " ")
        print(answer, flush=True)


if __name__ == "__main__":
    main()
