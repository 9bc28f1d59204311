"""Dymola's SpringFrictionPendulumExtForce1D (FMIZoo.jl, models/bin/Dymola/2023x/2.0): the same with dry friction of its own.

    m s'' = F - c (s - 1.1) - f(v),  f = (v + sign(v) (5 + 10 exp(-2 |v|))) / fricScale

with stiction by events (MassWithStopAndFriction of the Modelica library). Here the sign is tanh(v / 0.5 mm/s).
Hidden: nothing; in `friction_pendulum_spring.py` a spring that hardens.
"""

import numpy as np
from common import drive, main, multisine, solve

FMU = "SpringFrictionPendulumExtForce1D.fmu"
NOMINAL = dict(m=1.0, c=10.0, scale=20.0)
TRUE = dict(m=0.97, c=10.4, scale=20.8)
HIDDEN = {}
STEP, DURATION = 0.01, 30.0
MEASURED = {"v": "m/s", "a": "m/s2"}


def inputs(seed, time):
    return {("extForce", "N"): multisine(seed, time, 0.1, 5.0, 3.0)}


def respond(p, hidden, time, u):
    force = drive(time, u["extForce"])

    def acceleration(t, s, v):
        dry = (5.0 + 10.0 * np.exp(-2.0 * np.abs(v))) * np.tanh(v / 5e-4)
        spring = p["c"] * (s - 1.1) + hidden.get("cubic", 0.0) * (s - 1.1) ** 3
        return (force(t) - spring - (v + dry) / p["scale"]) / p["m"]

    s, v = solve(lambda t, y: [y[1], acceleration(t, *y)], [0.5, 0.0], time, 0.002, "LSODA")
    return {"v": v, "a": acceleration(time, s, v)}


if __name__ == "__main__":
    main(__name__)
