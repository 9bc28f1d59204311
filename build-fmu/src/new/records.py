"""Two records of a rig with friction that the model does not have: writes train.csv and test.csv.

    pip install scipy
    python3 tests/records.py            # or: python3 tests/records.py FOLDER

They stand in for yours. The equations are those of reference.py.
"""

import sys
from pathlib import Path

import numpy
from scipy.integrate import solve_ivp

from reference import MASS, acceleration

# Force in N, and velocity in m/s at which 76 % of it are reached.
FRICTION, VELOCITY = 3.0, 2e-3
STEP, DURATION = 2e-3, 10.0
NOISE = {"position": 1e-5, "velocity": 1e-3, "acceleration": 2e-2}


def excitation(seed):
    """A base that moves with all frequencies from 0.3 to 8 Hz."""
    frequency = numpy.arange(0.3, 8.0, 0.05)
    phase = numpy.random.default_rng(seed).uniform(0.0, 2.0 * numpy.pi, len(frequency))
    amplitude = 6e-3 / (1.0 + frequency)
    return lambda t: amplitude @ numpy.sin(2.0 * numpy.pi * frequency * t + phase)


def record(seed):
    base = excitation(seed)

    def measured(t, x, v):
        return acceleration(base(t), x, v) - FRICTION / MASS * numpy.tanh(v / VELOCITY)

    times = numpy.arange(0.0, DURATION, STEP)
    solution = solve_ivp(
        lambda t, y: [y[1], measured(t, *y)], (0.0, DURATION), [base(0.0), 0.0], "LSODA", times, rtol=1e-8, atol=1e-10
    )
    assert solution.success, solution.message
    x, v = solution.y
    columns = {
        "time": times,
        "base": numpy.array([base(t) for t in times]),
        "position": x,
        "velocity": v,
        "acceleration": numpy.array([measured(*row) for row in zip(times, x, v)]),
    }
    random = numpy.random.default_rng(seed + 100)
    for name, deviation in NOISE.items():
        columns[name] = columns[name] + random.normal(0.0, deviation, len(times))
    rows = [",".join(f"{value:.8g}" for value in row) for row in zip(*columns.values())]
    return "\n".join([",".join(columns), *rows]) + "\n"


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    for name, seed in [("train", 1), ("test", 2)]:
        (folder / f"{name}.csv").write_text(record(seed), encoding="utf-8")


if __name__ == "__main__":
    main()
