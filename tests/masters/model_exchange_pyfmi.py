"""Model exchange in PyFMI, run by the Python that has it: Assimulo's CVode, with inputs that move."""

import numpy as np
from other_python import serve
from pyfmi import load_fmu


def run(job):
    model = load_fmu(job["path"], kind="ME")
    options = model.simulate_options()
    options |= {"ncp": job["count"], "filter": job["outputs"]}
    options["CVode_options"]["rtol"] = job["tolerance"]
    table = (job["inputs"], np.array(job["table"])) if job["inputs"] else ()
    result = model.simulate(0.0, job["count"] * job["step"], input=table, options=options)
    # It records events, too. The last row before one belongs to what has just been.
    samples = job["step"] * np.arange(1, job["count"] + 1)
    rows = np.searchsorted(result["time"], samples - 1e-9)
    assert np.abs(result["time"][rows] - samples).max() < 1e-9, "a sample was not recorded"
    return np.array([result[name][rows] for name in job["outputs"]]).T


if __name__ == "__main__":
    serve(run)
