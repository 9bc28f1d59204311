"""A mass on a strut above a base that is moved, by the base's motion, its acceleration, or the deflection itself.

    m z_s'' = -F_strut(x, v) + F_act - F_guide,  F_guide = F_g tanh(z_s' / v0) + d_g z_s'
    x = z_s - z_b, v = x',  or x and v are given
"""

import math

from corner import Strut
from integrate import Smooth


class SprungMass(Smooth):
    states = ["body.position", "body.velocity", "base.position", "base.velocity"]
    inputs = ["motion.position", "motion.velocity", "motion.acceleration", "imposed.deflection", "imposed.velocity",
              "actuator.force"]
    outputs = ["body.acceleration", "suspension.deflection", "suspension.velocity", "base.force"]

    def __init__(self, parameters, settings):
        self.p = parameters
        self.drive = settings.get("drive", "Motion")
        self.strut = Strut(parameters)

    def travel(self, state, u):
        if self.drive == "Deflection":
            return u[3], u[4]
        base = u[0:2] if self.drive == "Motion" else state[2:4]
        return state[0] - base[0], state[1] - base[1]

    def guide(self, velocity):
        p = self.p
        friction = p["guide.coulomb.force"] * math.tanh(velocity / p["guide.coulomb.velocity"])
        return friction + p["guide.damping"] * velocity

    def forces(self, state, u):
        """What accelerates the mass, and what presses on the base."""
        strut = self.strut.force(*self.travel(state, u))
        return u[5] - strut - self.guide(state[1]), u[5] - strut

    def derivative(self, state, u, mode):
        base = (state[3], u[2]) if self.drive == "Acceleration" else (0.0, 0.0)
        return [state[1], self.forces(state, u)[0] / self.p["sprung_mass"], *base]

    def output(self, state, u, mode):
        moving, pressing = self.forces(state, u)
        return [moving / self.p["sprung_mass"], *self.travel(state, u), pressing]
