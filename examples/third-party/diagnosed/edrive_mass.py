"""Dymola's edrive_mass (OMSimulator, testsuite/tests/resources/dcmotor): an inertia with a damper between two torques.

    J w' = M_A + M_B - d w          outputs: wA = wB = w, phiA = phiB

Hidden: dry friction in the bearing; in `edrive_mass_drag.py` the drag of a fan.
"""

import numpy as np
from common import drive, main, multisine, solve

FMU = "edrive_mass.fmu"
NOMINAL = dict(J=0.002, d=0.001)
TRUE = dict(J=0.00206, d=0.00094)
HIDDEN = dict(friction=0.02)  # N.m
STEP, DURATION = 0.005, 25.0
MEASURED = {"wA": "rad/s", "phiA": "rad"}


def inputs(seed, time):
    return {("M_A", "N.m"): multisine(seed, time, 0.1, 8.0, 0.1), ("M_B", "N.m"): multisine(seed + 50, time, 0.15, 3.0, 0.03)}


def respond(p, hidden, time, u):
    torque, friction = drive(time, u["M_A"] + u["M_B"]), hidden.get("friction", 0.0)
    drag = hidden.get("drag", 0.0)
    loss = lambda w: p["d"] * w + friction * np.tanh(w / 0.1) + drag * w * np.abs(w)
    rate = lambda t, y: [y[1], (torque(t) - loss(y[1])) / p["J"]]
    phi, w = solve(rate, [0.0, 0.0], time, 0.002)
    return {"wA": w, "phiA": phi}


if __name__ == "__main__":
    main(__name__)
