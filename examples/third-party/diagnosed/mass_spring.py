"""OpenModelica's MassSpring (OMSimulator-testsuite, FMUs/MassSpring_me.fmu): mass, spring, damper, without any units.

    M v' = -f - k x - B v

Hidden: a damper that is stronger one way: B (1 + a) v for v > 0, B (1 - a) v for v < 0.
"""

import numpy as np
from common import drive, main, multisine, solve

FMU = "MassSpring.fmu"
NOMINAL = dict(M=100.0, k=3000.0, B=10.0)
TRUE = dict(M=103.0, k=2930.0, B=60.0)
HIDDEN = dict(asymmetry=0.5)
STEP, DURATION = 0.01, 30.0
NAMES = ["_D_outputStateAlias_x", "_D_outputStateAlias_v"]
MEASURED = {name: "" for name in NAMES}


def inputs(seed, time):
    return {("f", ""): multisine(seed, time, 0.1, 4.0, 150.0)}


def respond(p, hidden, time, u):
    force, a = drive(time, u["f"]), hidden.get("asymmetry", 0.0)
    rate = lambda t, y: [y[1], (-force(t) - p["k"] * y[0] - p["B"] * (1.0 + a * np.sign(y[1])) * y[1]) / p["M"]]
    x, v = solve(rate, [0.0, 0.0], time, 0.005)
    return dict(zip(NAMES, [x, v]))


if __name__ == "__main__":
    main(__name__)
