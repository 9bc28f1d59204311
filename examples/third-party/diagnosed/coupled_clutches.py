"""MapleSim 2024's CoupledClutches (Maplesoft-fmigroup/MapleSim_FMI, MapleSim_2024/FMI_Export/FMI_2/ME): the example of the Modelica
library, four inertias of 1 kg m2 with three clutches between them.

    w1' = 10 sin(10 pi t) - c1,  w2' = c1 - c2,  w3' = c2 - c3,  w4' = c3          outputs: w1 to w4
    c = 10 n sign(w' - w''),  n1 = max(cos(2 pi f t), 0),  n2 = 1 from T2 on,  n3 = max(input, 0)

It starts at w1 = 10 rad/s. A clutch that is stuck holds up to 11 n, which is left out here. The sign is tanh(w / 2 mrad/s).
Hidden: a lag of the sensor of w4.
"""

import numpy as np
from common import drive, lagged, main, multisine, solve

FMU = "CoupledClutches.fmu"
NOMINAL = dict(freqHz=0.2, T2=0.4)
TRUE = dict(freqHz=0.206, T2=0.4)
HIDDEN = dict(lag=0.03)  # s
STEP, DURATION = 0.005, 5.0
EVENTS = True
MEASURED = {f"outputs[{i}]": "rad/s" for i in range(1, 5)}


def inputs(seed, time):
    return {("inputs", ""): 0.3 + multisine(seed, time, 0.2, 3.0, 0.15)}


def respond(p, hidden, time, u):
    pressure = drive(time, u["inputs"])

    def rate(t, w):
        normal = [max(np.cos(2.0 * np.pi * p["freqHz"] * t), 0.0), float(t >= p["T2"]), max(pressure(t), 0.0)]
        c1, c2, c3 = 10.0 * np.array(normal) * np.tanh(-np.diff(w) / 0.002)
        return [10.0 * np.sin(10.0 * np.pi * t) - c1, c1 - c2, c2 - c3, c3]

    w = list(solve(rate, [10.0, 0.0, 0.0, 0.0], time, 0.002, "LSODA"))
    if "lag" in hidden:
        w[3] = lagged(time, w[3], hidden["lag"])
    return dict(zip(MEASURED, w))


if __name__ == "__main__":
    main(__name__)
