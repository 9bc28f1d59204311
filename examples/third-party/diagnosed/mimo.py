"""qFMU's MIMO (hyumo/qFMU, examples/2.0/me/linux64): three states, two inputs, two outputs.

    x1' = -x1 + u2,  x2' = -2 x2 + u1 + u2,  x3' = -3 x3 - u1          outputs: y1 = x2 + x3, y2 = x1 + x2 + x3

Hidden: the system sees u2 through a lag that the record's u2 does not have.
"""

from common import drive, lagged, main, multisine, solve

FMU = "MIMO.fmu"
NOMINAL = TRUE = {}  # no parameter can be fitted
HIDDEN = dict(lag=0.08)  # s
STEP, DURATION = 0.02, 40.0
MEASURED = {"y1": "", "y2": ""}


def inputs(seed, time):
    return {("u1", ""): multisine(seed, time, 0.05, 3.0, 1.0), ("u2", ""): multisine(seed + 50, time, 0.06, 3.0, 1.0)}


def respond(p, hidden, time, u):
    u1 = drive(time, u["u1"])
    u2 = drive(time, lagged(time, u["u2"], hidden["lag"]) if "lag" in hidden else u["u2"])
    rate = lambda t, x: [-x[0] + u2(t), -2.0 * x[1] + u1(t) + u2(t), -3.0 * x[2] - u1(t)]
    x1, x2, x3 = solve(rate, [0.0, 0.0, 0.0], time)
    return {"y1": x2 + x3, "y2": x1 + x2 + x3}


if __name__ == "__main__":
    main(__name__)
