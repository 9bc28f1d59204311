"""Dymola's emachine_model (OMSimulator, testsuite/tests/resources/dcmotor): the armature of a direct-current motor.

    L i' = U - R i - k w          outputs: I = i, M = torque on the shaft = k i

Hidden: a lag of the current's sensor; the torque's sensor is right. In `emachine_hot.py` a resistance that grows with the current.
"""

from common import drive, lagged, main, multisine, solve

FMU = "emachine_model.fmu"
NOMINAL = dict(R=1.0, L=1e-3, k=0.01)
TRUE = dict(R=1.04, L=1.05e-3, k=0.0098)
HIDDEN = dict(lag=0.003)  # s
STEP, DURATION = 0.002, 20.0
MEASURED = {"I": "A", "M": "N.m"}


def inputs(seed, time):
    return {("U", "V"): multisine(seed, time, 0.2, 80.0, 5.0), ("w", "rad/s"): multisine(seed + 50, time, 0.1, 20.0, 300.0)}


def respond(p, hidden, time, u):
    voltage, speed = drive(time, u["U"]), drive(time, u["w"])
    drop = lambda i: p["R"] * i + hidden.get("cubic", 0.0) * i**3
    (i,) = solve(lambda t, y: [(voltage(t) - drop(y[0]) - p["k"] * speed(t)) / p["L"]], [0.0], time)
    return {"I": lagged(time, i, hidden["lag"]) if "lag" in hidden else i, "M": p["k"] * i}


if __name__ == "__main__":
    main(__name__)
