"""Jobs in PyFMI, run by the Python that has it: single FMUs in co-simulation, and systems by its Master."""

import numpy as np
from other_python import serve
from pyfmi import load_fmu
from pyfmi.fmi2 import FMI2_CONTINUOUS
from pyfmi.master import Master


def parts(end):
    """Component and variable of "component.variable"."""
    return end.split(".", 1)


def both_ways_last(models, connections):
    """The models that continuous values enter and leave, after the others.

    In systems with direct feed-through, PyFMI 2.21.0 takes the shape of a matrix from the last of them
    (`Master.compute_global_D`): where that has no continuous output, for instance a controller, it says "matmul: dimension
    mismatch".
    """
    ways = set()
    for source, output, target, input in connections:
        if all(m.get_variable_variability(name) == FMI2_CONTINUOUS for m, name in ((source, output), (target, input))):
            ways |= {(source, "out"), (target, "in")}
    return sorted(models, key=lambda model: sum((model, way) in ways for way in ("in", "out")))


def system(job, models, filters):
    """What Master records of each model."""
    ends = [(*parts(source), *parts(target)) for source, target in job["connections"]]
    connections = [(models[source], output, models[target], input) for source, output, target, input in ends]
    ordered = both_ways_last(models.values(), connections)
    options = {
        "step_size": job["step"], "local_rtol": job["tolerance"], "result_handling": "memory",
        "filter": {models[name]: filters[name] for name in models},
    }  # fmt: skip
    results = Master(ordered, connections).simulate(0.0, job["step"] * job["count"], options=options)
    return {name: results[ordered.index(model)] for name, model in models.items()}


def run(job):
    models = {name: load_fmu(path, kind="CS") for name, path in job["components"].items()}
    for end, value in job["values"].items():
        component, variable = parts(end)
        models[component].set(variable, value)
    signals = [parts(signal) for signal in job["signals"]]
    filters = {name: [variable for component, variable in signals if component == name] for name in models}
    if job["connections"]:
        results = system(job, models, filters)
    else:
        ((name, model),) = models.items()
        options = {"ncp": job["count"], "result_handling": "memory", "filter": filters[name]}
        results = {name: model.simulate(0.0, job["step"] * job["count"], options=options)}
    return np.array([results[component][variable] for component, variable in signals]).T[1:]


if __name__ == "__main__":
    serve(run)
