"""OpenModelica's DualMassOscillator.System2 (OMSimulator-testsuite, FMUs): a mass between a moved end and a wall, all springs
with dampers.

    m s2'' = -F_c + c2 (2 - s2) - d2 s2',  F_c = cc (s2 - s1 - 1) + dc (s2' - s1')          output: F = F_c

It rests at s1 = 1, s2 = 2. Hidden: nothing.
"""

from common import drive, main, multisine, solve

FMU = "DualMassOscillator.System2.fmu"
NOMINAL = dict(m=1.0, c2=1e5, d2=6.3246, cc=1e6, dc=14.1421)
TRUE = dict(m=1.03, c2=0.97e5, d2=6.6, cc=1.03e6, dc=14.6)
HIDDEN = {}
STEP, DURATION = 0.001, 20.0
MEASURED = {"F": ""}


def inputs(seed, time):
    s1 = multisine(seed, time, 0.5, 60.0, 1e-3, 1.0)
    # It starts at rest.
    s1 = 1.0 + (s1 - s1[0]) * (1.0 - 1.0 / (1.0 + (time / 0.2) ** 4))
    move = drive(time, s1)
    return {("s1", ""): s1, ("v1", ""): move(time, 1), ("a1", ""): move(time, 2)}


def respond(p, hidden, time, u):
    s1, v1 = drive(time, u["s1"]), drive(time, u["v1"])
    coupling = lambda t, s, v: p["cc"] * (s - s1(t) - 1.0) + p["dc"] * (v - v1(t))
    rate = lambda t, y: [y[1], (-coupling(t, *y) + p["c2"] * (2.0 - y[0]) - p["d2"] * y[1]) / p["m"]]
    s, v = solve(rate, [2.0, 0.0], time)
    return {"F": coupling(time, s, v)}


if __name__ == "__main__":
    main(__name__)
