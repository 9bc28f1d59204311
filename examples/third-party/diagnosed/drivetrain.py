"""Dymola's Drivetrain (FMPy, tests/resources): two inertias, a torsion spring with a damper between, a constant load.

    J1 w1' = tau + c p + d p',  J2 w2' = -c p - d p' + 10 N.m,  p' = w2 - w1        output: w = w1

The FMU starts with a twist that follows from its input; a record does not, and the difference is gone after 0.2 s.
Hidden: a lag of the sensor of w.
"""

from common import drive, lagged, main, multisine, solve

FMU = "Drivetrain.fmu"
NOMINAL = dict(J1=1.0, J2=2.0, c=1e4, d=100.0)
TRUE = dict(J1=1.03, J2=1.95, c=1.04e4, d=95.0)
HIDDEN = dict(lag=0.006)  # s
STEP, DURATION = 0.002, 20.0
MEASURED = {"w": "rad/s"}


def inputs(seed, time):
    return {("tau", "N.m"): -10.0 + multisine(seed, time, 0.2, 45.0, 60.0)}


def respond(p, hidden, time, u):
    torque = drive(time, u["tau"])

    def rate(t, y):
        twist, first, second = y
        shaft = p["c"] * twist + p["d"] * (second - first)
        return [second - first, (torque(t) + shaft) / p["J1"], (10.0 - shaft) / p["J2"]]

    w = solve(rate, [0.0, 0.0, 0.0], time)[1]
    return {"w": lagged(time, w, hidden["lag"]) if "lag" in hidden else w}


if __name__ == "__main__":
    main(__name__)
