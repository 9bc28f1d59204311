"""Dymola's Controller (FMPy, tests/resources): the PI controller with a limit of the Modelica library (LimPID).

    y = limit(k (u_s - u_m + x)),  x' = (u_s - u_m + (y - y0) / (k Ni)) / Ti,  y0 before the limit

Hidden: the controller sees u_m through a lag that the record's u_m does not have.
"""

import numpy as np
from common import drive, lagged, main, multisine, solve

FMU = "Controller.fmu"
NOMINAL = dict(k=100.0, Ti=0.1, Ni=0.1, limit=12.0)
TRUE = dict(k=97.0, Ti=0.104, Ni=0.1, limit=12.0)
HIDDEN = dict(lag=0.01)  # s
STEP, DURATION = 0.005, 20.0
MEASURED = {"y": ""}


def inputs(seed, time):
    # The FMU initialises with equal inputs only.
    rise = 1.0 - np.exp(-((time / 0.2) ** 2))
    return {("u_s", ""): rise * multisine(seed, time, 0.1, 5.0, 0.04), ("u_m", ""): rise * multisine(seed + 50, time, 0.15, 8.0, 0.04)}


def respond(p, hidden, time, u):
    set_point, measured = drive(time, u["u_s"]), drive(time, u["u_m"])
    if "lag" in hidden:
        measured = drive(time, lagged(time, u["u_m"], hidden["lag"]))

    def output(t, x):
        free = p["k"] * (set_point(t) - measured(t) + x)
        return np.clip(free, -p["limit"], p["limit"]), free

    def rate(t, y):
        out, free = output(t, y[0])
        return [(set_point(t) - measured(t) + (out - free) / (p["k"] * p["Ni"])) / p["Ti"]]

    (x,) = solve(rate, [0.0], time, 0.002)
    return {"y": output(time, x)[0]}


if __name__ == "__main__":
    main(__name__)
