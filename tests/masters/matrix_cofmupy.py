"""Jobs in cofmupy, run by the Python that has it."""

import numpy as np
from cofmupy import Coordinator
from other_python import serve


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
    return np.array([results[tuple(signal.split(".", 1))] for signal in job["signals"]]).T


if __name__ == "__main__":
    serve(run)
