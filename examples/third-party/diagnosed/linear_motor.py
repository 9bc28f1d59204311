"""Strut's LinearMotor (build-fmu, taken as another maker's): the current of a linear motor behind its inverter.

    u' = 250 (v - u),  x' = -320.402 x + 1.2131 u,  i = 839.408 x,  force = 100 N/A i

(equations of the description; far below its limits). Hidden: the inverter clips the command at 1.5 V.
"""

import numpy as np
from common import drive, main, multisine, solve

FMU = "LinearMotor.fmu"
NOMINAL = dict(pole=320.402, delay_pole=250.0, gain=839.408, constant=100.0)
TRUE = dict(pole=320.402, delay_pole=250.0, gain=839.408, constant=103.0)
HIDDEN = dict(limit=1.5)  # V
STEP, DURATION = 0.002, 20.0
MEASURED = {"current": "A", "force": "N"}


def inputs(seed, time):
    return {("voltage", "V"): multisine(seed, time, 0.2, 30.0, 0.9)}


def respond(p, hidden, time, u):
    voltage, limit = drive(time, u["voltage"]), hidden.get("limit", 100.0)

    def rate(t, y):
        return [p["delay_pole"] * (np.clip(voltage(t), -limit, limit) - y[0]), -p["pole"] * y[1] + 1.2131 * y[0]]

    i = p["gain"] * solve(rate, [0.0, 0.0], time)[1]
    return {"current": i, "force": p["constant"] * i}


if __name__ == "__main__":
    main(__name__)
