"""Dymola's SpringPendulumExtForce1D (FMIZoo.jl, models/bin/Dymola/2023x/2.0): as in `spring_pendulum.py`, of a later Dymola.

    m s'' = F - c (s - 1.1)

Hidden, and in no list: damping that grows away from the middle, b (s - 1.1)2 s'.
"""

from common import drive, main, multisine, solve

FMU = "SpringPendulumExtForce1D_2023x.fmu"
NOMINAL = dict(m=1.0, c=10.0)
TRUE = dict(m=0.96, c=10.4)
HIDDEN = dict(rate=1.5)  # N.s/m3
STEP, DURATION = 0.01, 30.0
MEASURED = {"v": "m/s", "a": "m/s2"}


def inputs(seed, time):
    return {("extForce", "N"): multisine(seed, time, 0.1, 5.0, 3.0)}


def respond(p, hidden, time, u):
    force, rate = drive(time, u["extForce"]), hidden.get("rate", 0.0)

    def acceleration(t, s, v):
        return (force(t) - p["c"] * (s - 1.1) - rate * (s - 1.1) ** 2 * v) / p["m"]

    s, v = solve(lambda t, y: [y[1], acceleration(t, *y)], [0.5, 0.0], time, 0.005)
    return {"v": v, "a": acceleration(time, s, v)}


if __name__ == "__main__":
    main(__name__)
