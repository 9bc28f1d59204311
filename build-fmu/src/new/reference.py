"""The model's equations once more, integrated by scipy: writes reference.csv beside this file.

    pip install scipy
    python3 tests/reference.py

Run it after every change of the equations, the start values or the experiment.
"""

from pathlib import Path

import numpy
from scipy.integrate import solve_ivp

MASS, DAMPING, STIFFNESS, HARDENING = 10.0, 60.0, 2000.0, 1e6
STEP, STOP = 0.01, 4.0
STEP_AT, HEIGHT = 1.0, 0.02


def acceleration(base, x, v):
    e = base - x
    return (STIFFNESS * e + HARDENING * e**3 - DAMPING * v) / MASS


def main():
    rows, state = [], [0.0, 0.0]
    # One piece before the base steps and one after: no integrator looks across a jump.
    for begin, end, base in [(0.0, STEP_AT, 0.0), (STEP_AT, STOP, HEIGHT)]:
        first, last = round(begin / STEP), round(end / STEP)
        times = numpy.arange(first, last + 1) * STEP
        solution = solve_ivp(
            lambda _, y: [y[1], acceleration(base, *y)],
            (times[0], times[-1]),
            state,
            method="DOP853",
            t_eval=times,
            rtol=1e-11,
            atol=1e-14,
        )
        assert solution.success, solution.message
        state = solution.y[:, -1]
        kept = slice(None, None if end == STOP else -1)
        for t, x, v in zip(times[kept], *solution.y[:, kept]):
            rows.append((t, x, acceleration(base, x, v)))
    lines = ["time,position,acceleration"] + [f"{t:.2f},{x:.10e},{a:.10e}" for t, x, a in rows]
    Path(__file__).with_name("reference.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
