"""A damper on a test bench, set by the current or the voltage of its coil. The lower end is moved, the upper one clamped:

    x = -z, v = -z',  F = -(k x + d(s) v + F_y(s) tanh(v/v_y + beta x) + F_p)
    T s' = |i|/i_r - s,  or |u|/u_r in place of |i|/i_r;  m = s/(1 + kappa s)
    d(s) = d + d_s m,  F_y(s) = F_y + F_s m
"""

import math

from integrate import Smooth


class ElementDyno(Smooth):
    states = ["control.arrived"]
    inputs = ["motion.position", "motion.velocity", "control.current", "control.voltage"]
    outputs = ["force", "deflection"]

    def __init__(self, parameters, settings):
        self.p = parameters
        self.by_current = settings["controlled_by"] == "Current"

    def derivative(self, state, u, mode):
        p = self.p
        share = u[2] / p["control.rated_current"] if self.by_current else u[3] / p["control.rated_voltage"]
        return [(abs(share) - state[0]) / p["control.lag"]]

    def output(self, state, u, mode):
        p = self.p
        x, v = -u[0], -u[1]
        field = state[0] / (1.0 + p["control.saturation"] * state[0])
        damping = p["strut.damping"] + p["control.damping"] * field
        plastic = p["strut.yield.force"] + p["control.yield_force"] * field
        force = (p["strut.stiffness"] * x + damping * v + p["strut.preload"]
                 + plastic * math.tanh(v / p["strut.yield.velocity"] + p["strut.yield.slope"] * x))
        return [-force, x]
