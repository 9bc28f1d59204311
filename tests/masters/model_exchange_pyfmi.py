"""Model exchange in PyFMI, run by the Python that has it: Assimulo's CVode, with inputs that move."""

import numpy as np
from other_python import serve
from pyfmi import load_fmu
from recorded import before_events


def run(job):
    model = load_fmu(job["path"], kind="ME")
    options = model.simulate_options()
    options |= {"ncp": job["count"], "filter": job["outputs"]}
    options["CVode_options"]["rtol"] = job["tolerance"]
    table = (job["inputs"], np.array(job["table"])) if job["inputs"] else ()
    result = model.simulate(0.0, job["count"] * job["step"], input=table, options=options)
    return before_events(result, job["outputs"], job["step"] * np.arange(1, job["count"] + 1))


if __name__ == "__main__":
    serve(run)
