"""Two records of the quarter car by scipy, with friction in its strut that the model does not have.

    python records.py [FOLDER] [FORCE]

The equations are written anew here: nothing is shared with the model. FORCE is the friction in N, 80 if it is not given.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfiltfilt

RATE, DURATION = 500.0, 20.0
NOISE = 0.003
# The rig's values; its masses, springs and damper are not quite what the model starts with.
BODY, WHEEL = 312.0, 41.0
STIFFNESS, LENGTH, EXPONENT, DAMPING = 12600.0, 0.4, 1.3, 1330.0
CLEARANCE, STOP, TIRE = 0.05, 60000.0, 186000.0
# Below this velocity, friction turns over.
STICKS = 1e-3


def strut(x, v, friction):
    """Force that pushes body and wheel apart, beyond what carries the body."""
    gas = STIFFNESS * LENGTH / EXPONENT * ((1.0 + x / LENGTH) ** -EXPONENT - 1.0)
    stop = STOP * max(-x - CLEARANCE, 0.0)
    return gas + stop - DAMPING * v - friction * np.tanh(v / STICKS)


def record(friction, seed):
    """Columns of a record: a rough road with a few bumps that reach the stop."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, DURATION, 1.0 / RATE)
    noise = sosfiltfilt(butter(1, [0.3, 12.0], "bandpass", fs=RATE, output="sos"), random.standard_normal(time.size))
    bumps = sum(0.05 * np.exp(-(((time - at) / 0.08) ** 2)) for at in random.uniform(2.0, DURATION - 2.0, 5))
    # It begins at rest.
    road = CubicSpline(time, (0.012 * noise / noise.std() + bumps) * np.minimum(time, 1.0))

    def rates(t, state):
        body, body_velocity, wheel, wheel_velocity = state
        force = strut(body - wheel, body_velocity - wheel_velocity, friction)
        return [body_velocity, force / BODY, wheel_velocity, (TIRE * (road(t) - wheel) - force) / WHEEL]

    solved = solve_ivp(rates, (0.0, DURATION), [0.0] * 4, "LSODA", time, rtol=1e-8, atol=1e-10, max_step=2e-3)
    body, _, wheel, _ = solved.y
    accelerations = np.array([rates(t, state) for t, state in zip(time, solved.y.T)])[:, [1, 3]].T
    signals = {
        "road.position [m]": road(time),
        "body.acceleration [m/s2]": accelerations[0],
        "wheel.acceleration [m/s2]": accelerations[1],
        "suspension.deflection [m]": body - wheel,
    }
    measured = {name: it + NOISE * it.std() * random.standard_normal(it.size) for name, it in signals.items()}
    return {"time [s]": time} | measured


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    friction = float(sys.argv[2] if len(sys.argv) > 2 else 80.0)
    for name, seed in (("train.csv", 1), ("test.csv", 2)):
        columns = record(friction, seed)
        rows = np.column_stack(list(columns.values()))
        np.savetxt(folder / name, rows, "%.9g", ",", header=",".join(columns), comments="")


if __name__ == "__main__":
    main()
