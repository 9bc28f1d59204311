"""Records of a mass on a spring and a damper, with friction hidden in it, for the FMU `Mass_Damper.fmu` of OpenModelica.

    python examples/third-party/damper_records.py FOLDER [FRICTION [SECONDS]]

writes `damper-train.csv` and `damper-test.csv`: the force, and position and acceleration of the mass with noise. The equations
are solved by scipy; nothing of the FMU or of Strut is in them. Mass, spring and damper are not quite those of the FMU.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

STEP, DURATION = 1e-3, 10.0
MASS, SPRING, DAMPER = 1.02, 9800.0, 10.6
# Velocity over which dry friction turns over, in m/s.
SLIDING = 0.01
# Where the FMU has the mass at rest with the spring of damper-rig.toml, in m.
REST = 0.0
NOISE = 0.005


def record(seed, friction, duration):
    """Columns of a record: a multisine of the force in N, position in m, acceleration in m/s2."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, duration, STEP)
    frequencies = np.arange(0.5, 30.0, 0.25)
    phases = random.uniform(0.0, 2.0 * np.pi, len(frequencies))
    force = 6.0 * np.sin(2.0 * np.pi * frequencies[:, None] * time + phases[:, None]).sum(0)
    drive = CubicSpline(time, force)

    def accelerations(t, x, v):
        return (drive(t) - DAMPER * v - SPRING * x - friction * np.tanh(v / SLIDING)) / MASS

    solved = solve_ivp(
        lambda t, y: [y[1], accelerations(t, *y)], (0.0, time[-1]), [0.0, 0.0], t_eval=time, rtol=1e-8, atol=1e-11, max_step=STEP
    )
    x, v = solved.y
    seen = [x, accelerations(time, x, v)]
    position, acceleration = (y + NOISE * np.std(y) * random.standard_normal(len(y)) for y in seen)
    return np.column_stack([time, force, REST + position, acceleration])


def main():
    folder = Path(sys.argv[1])
    friction = float(sys.argv[2]) if len(sys.argv) > 2 else 8.0
    duration = float(sys.argv[3]) if len(sys.argv) > 3 else DURATION
    for seed, name in [(1, "train"), (2, "test")]:
        header = "time [s],f [N],mass.s [m],mass.a [m/s2]"
        path = folder / f"damper-{name}.csv"
        np.savetxt(path, record(seed, friction, duration), fmt="%.9g", delimiter=",", header=header, comments="")
        print(path)


main()
