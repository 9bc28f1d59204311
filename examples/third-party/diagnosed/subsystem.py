"""OpenModelica's MassSpringSubSystem1 (wheel of gemseo-fmu 3.1.1): a mass between a wall and a moved end. Masses and springs are
inputs, and 1 where no record moves them.

    m1 x1'' = -k1 x1 + k2 (x2 - x1)

Hidden: a lag of the sensor of x1; the one of v1 is right.
"""

from common import drive, lagged, main, multisine, solve

FMU = "MassSpringSubSystem1.fmu"
NOMINAL = dict(m1=1.0, k1=1.0, k2=1.0)
TRUE = NOMINAL  # no parameter can be fitted
HIDDEN = dict(lag=0.1)  # s
BEGINS = [1.0, 0.0]  # v1, x1
STEP, DURATION = 0.02, 30.0
MEASURED = {"x1": "", "v1": ""}


def inputs(seed, time):
    return {("x2", ""): multisine(seed, time, 0.05, 2.0, 0.5)}


def respond(p, hidden, time, u):
    end = drive(time, u["x2"])
    rate = lambda t, y: [y[1], (-p["k1"] * y[0] + p["k2"] * (end(t) - y[0])) / p["m1"]]
    x, v = solve(rate, BEGINS[::-1], time)
    return {"x1": lagged(time, x, hidden["lag"]) if "lag" in hidden else x, "v1": v}


if __name__ == "__main__":
    main(__name__)
