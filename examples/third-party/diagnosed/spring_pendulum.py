"""Dymola's SpringPendulumExtForce1D (FMIZoo.jl, models/bin/Dymola/2022x/2.0): a mass on a spring, driven by a force.

    m s'' = F - c (s - 0.1 - 1)          it starts at s = 0.5

Hidden: Coulomb friction.
"""

import numpy as np
from common import drive, main, multisine, solve

FMU = "SpringPendulumExtForce1D.fmu"
NOMINAL = dict(m=1.0, c=10.0)
TRUE = dict(m=1.03, c=9.7)
HIDDEN = dict(friction=0.5)  # N
STEP, DURATION = 0.01, 30.0
MEASURED = {"v": "m/s", "a": "m/s2"}


def inputs(seed, time):
    return {("extForce", "N"): multisine(seed, time, 0.1, 5.0, 3.0)}


def respond(p, hidden, time, u):
    force, friction = drive(time, u["extForce"]), hidden.get("friction", 0.0)

    def acceleration(t, s, v):
        return (force(t) - p["c"] * (s - 1.1) - friction * np.tanh(v / 0.005)) / p["m"]

    s, v = solve(lambda t, y: [y[1], acceleration(t, *y)], [0.5, 0.0], time, 0.002)
    return {"v": v, "a": acceleration(time, s, v)}


if __name__ == "__main__":
    main(__name__)
