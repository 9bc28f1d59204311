"""OpenModelica's HelloWorldWithInput (OMSimulator-testsuite, FMUs): one state.

    x' = a x + u,  a = -1          it starts at x = 1

Hidden, and in no list: a third power, -b x3. The FMU has no output; x is a local variable.
"""

from common import drive, lagged, main, multisine, solve

FMU = "HelloWorldWithInput.fmu"
NOMINAL = dict(a=-1.0)
TRUE = dict(a=-1.03)
HIDDEN = dict(cubic=0.3)
STEP, DURATION = 0.02, 30.0
MEASURED = {"x": ""}


def inputs(seed, time):
    return {("u", ""): multisine(seed, time, 0.05, 2.0, 2.0)}


def respond(p, hidden, time, u):
    u, cubic = drive(time, u["u"]), hidden.get("cubic", 0.0)
    (x,) = solve(lambda t, y: [p["a"] * y[0] + u(t) - cubic * y[0] ** 3], [1.0], time)
    return {"x": lagged(time, x, hidden["lag"]) if "lag" in hidden else x}


if __name__ == "__main__":
    main(__name__)
