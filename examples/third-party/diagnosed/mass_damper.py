"""OpenModelica's Mass_Damper (wheel of gemseo-fmu 3.1.1): the seat, a mass on a spring and a damper.

    m x'' = f - c x - d x'          mass.s = -0.5 + x

Hidden: an end stop, another spring of 20 N/mm from x = 15 mm on.
"""

import numpy as np
from common import drive, main, multisine, solve

FMU = "Mass_Damper.fmu"
BEGINS = [1.0, 0.0]  # damper.s_rel, damper.v_rel
NOMINAL = dict(m=1.0, c=1e4, d=10.0)
TRUE = dict(m=1.02, c=9800.0, d=10.6)
HIDDEN = dict(stiffness=20000.0, clearance=0.015)  # N/m, m
STEP, DURATION = 0.002, 20.0
MEASURED = {"mass.s": "m", "mass.a": "m/s2"}


def inputs(seed, time):
    return {("f", "N"): multisine(seed, time, 0.5, 30.0, 60.0)}


def respond(p, hidden, time, u):
    force, stop, clearance = drive(time, u["f"]), hidden.get("stiffness", 0.0), hidden.get("clearance", 1.0)

    def acceleration(t, x, v):
        return (force(t) - p["c"] * x - p["d"] * v - stop * np.maximum(x - clearance, 0.0)) / p["m"]

    x, v = solve(lambda t, y: [y[1], acceleration(t, *y)], [0.0, 0.0], time, 0.001)
    return {"mass.s": x - 0.5, "mass.a": acceleration(time, x, v)}


if __name__ == "__main__":
    main(__name__)
