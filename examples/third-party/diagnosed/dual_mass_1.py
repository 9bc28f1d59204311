"""OpenModelica's DualMassOscillator.System1 (OMSimulator-testsuite, FMUs): a mass on a spring and a damper, driven by a force.

    m s1'' = F - c (s1 - 1) - d s1'          it rests at s1 = 1

Hidden: a spring that hardens, c x (1 + r x2), x = s1 - 1.
"""

from common import drive, main, multisine, solve

FMU = "DualMassOscillator.System1.fmu"
NOMINAL = dict(m=1.0, c=1e4, d=2.0)
TRUE = dict(m=1.02, c=9800.0, d=2.15)
HIDDEN = dict(cubic=2e6)  # N/m3
STEP, DURATION = 0.002, 20.0
MEASURED = {"s1": "", "a1": ""}


def inputs(seed, time):
    return {("F", ""): multisine(seed, time, 0.5, 35.0, 60.0)}


def respond(p, hidden, time, u):
    force, cubic = drive(time, u["F"]), hidden.get("cubic", 0.0)

    def acceleration(t, s, v):
        x = s - 1.0
        return (force(t) - p["c"] * x - cubic * x**3 - p["d"] * v) / p["m"]

    s, v = solve(lambda t, y: [y[1], acceleration(t, *y)], [1.0, 0.0], time)
    return {"s1": s, "a1": acceleration(time, s, v)}


if __name__ == "__main__":
    main(__name__)
