"""qFMU's GuidedMass: a mass of 20 kg on a vertical guide, above a moved table on a spring and a damper, as a linear state space.

    m x'' = F - k (x - z) - d (x' - z')          outputs: x, x', x'', x - z, x' - z'

qFMU (PyPI, qfmu 0.2.9) makes it of its matrices. Its FMUs have start values as their only parameters, so the records have the FMU's
mass, spring and damper:

    qfmu ss -A "[[0,1],[-400,-7.5]]" -B "[[0,0,0],[0.05,400,7.5]]" -C "[[1,0],[0,1],[-400,-7.5],[1,0],[0,1]]" \
        -D "[[0,0,0],[0,0,0],[0.05,400,7.5],[0,-1,0],[0,0,-1]]" -o GuidedMass.fmu

Hidden: dry friction of the guide. `guided_mass_*.py` hide something else. `guided_mass.toml` is for all of them.
"""

import numpy as np
from common import drive, lagged, main, multisine, solve

FMU = "GuidedMass.fmu"
NOMINAL = dict(m=20.0, k=8000.0, d=150.0)
TRUE = NOMINAL  # no parameter can be fitted
HIDDEN = dict(friction=10.0)  # N
STEP, DURATION = 0.004, 20.0
MEASURED = {"y1": "", "y3": ""}


def inputs(seed, time):
    # It starts at rest.
    rise = 1.0 - np.exp(-((time / 0.3) ** 2))
    table = rise * multisine(seed, time, 0.5, 12.0, 3e-3, 0.5)
    return {
        ("u1", ""): rise * multisine(seed + 50, time, 0.4, 12.0, 30.0),
        ("u2", ""): table,
        ("u3", ""): drive(time, table)(time, 1),
    }


def respond(p, hidden, time, u):
    force, table = drive(time, u["u1"]), drive(time, u["u2"])

    def guide(x, v):
        tight = hidden.get("tight", 0.0) * np.exp(-((x / hidden.get("width", 1.0)) ** 2)) * v
        return hidden.get("friction", 0.0) * np.tanh(v / 0.002) + tight

    def acceleration(t, x, v):
        e, r = x - table(t), v - table(t, 1)
        return (force(t) - p["k"] * e - hidden.get("cubic", 0.0) * e**3 - p["d"] * r - guide(x, v)) / p["m"]

    x, v = solve(lambda t, y: [y[1], acceleration(t, *y)], [0.0, 0.0], time, 0.002)
    a = acceleration(time, x, v)
    y1 = lagged(time, x, hidden["lag"]) if "lag" in hidden else x
    return {"y1": y1, "y3": a}


if __name__ == "__main__":
    main(__name__)
