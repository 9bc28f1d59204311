"""A damper on a test bench, which the current or the voltage of its coil may set. The lower end is moved, the upper one clamped:

    x = -z, v = -z',  F = -(k x + d(s) v + F_y(s) tanh(v/v_y + beta x) + F_p)
    T s' = |i|/i_r - s,  or |u|/u_r in place of |i|/i_r;  m = s/(1 + kappa s)
    d(s) = d + d_s m,  F_y(s) = F_y + F_s m

Behind a loose clevis, x - e and u stand for x and v: u = dz(e, g)/T, e' = v - u, T = 0.5 ms.
"""

import math

from integrate import Switched

CATCHES_UP = 5e-4


class ElementDyno(Switched):
    states = ["control.arrived", "clevis.deflection"]
    inputs = ["motion.position", "motion.velocity", "control.current", "control.voltage"]
    outputs = ["force", "deflection"]

    def __init__(self, parameters, settings):
        self.p = parameters
        self.by = settings["controlled_by"]
        self.gap = parameters.get("clevis.gap", 0.0)
        self.guard_count = 2 if self.gap else 0

    def guards(self, state, _u):
        return [state[1] - self.gap, -self.gap - state[1]] if self.gap else []

    def motion(self, state, u, mode):
        """Deflection and velocity of the strut."""
        x, v = -u[0], -u[1]
        if not self.gap:
            return x, v
        beyond = state[1] - self.gap if mode[0] else state[1] + self.gap if mode[1] else 0.0
        return x - state[1], beyond / CATCHES_UP

    def derivative(self, state, u, mode):
        p = self.p
        shares = {"Current": u[2] / p.get("control.rated_current", 1.0), "Voltage": u[3] / p.get("control.rated_voltage", 1.0)}
        arriving = (abs(shares[self.by]) - state[0]) / p["control.lag"] if self.by in shares else 0.0
        return [arriving, -u[1] - self.motion(state, u, mode)[1] if self.gap else 0.0]

    def output(self, state, u, mode):
        p = self.p
        x, v = self.motion(state, u, mode)
        field = state[0] / (1.0 + p.get("control.saturation", 0.0) * state[0])
        damping = p["strut.damping"] + p.get("control.damping", 0.0) * field
        plastic = p["strut.yield.force"] + p.get("control.yield_force", 0.0) * field
        force = (p["strut.stiffness"] * x + damping * v + p["strut.preload"]
                 + plastic * math.tanh(v / p["strut.yield.velocity"] + p["strut.yield.slope"] * x))
        return [-force, -u[0]]
