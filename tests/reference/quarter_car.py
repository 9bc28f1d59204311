"""The quarter car, TUM 4.3-4.4: strut and tyre of `corner`, and the friction of the body's guides.

    m_s z_s'' = -F_strut + F_act - F_guide,  F_guide = F_g tanh(z_s' / v0)
    m_u z_u'' =  F_strut - F_act + F_tire

A hybrid model because its tyre is one: `derivative` depends on the mode, never on a guard's sign.
"""

import math

from corner import Strut, Tire
from integrate import Smooth
from parameter_sets import G


class QuarterCar(Smooth):
    states = ["body.position", "body.velocity", "wheel.position", "wheel.velocity"]
    inputs = ["road.position", "road.velocity", "actuator.force"]
    outputs = ["body.acceleration", "wheel.acceleration", "suspension.deflection",
               "suspension.velocity", "tire.deflection", "wheel.force"]
    guard_count = Tire.guard_count

    def __init__(self, parameters, settings=None):
        p = parameters
        self.ms, self.mu = p["sprung_mass"], p["unsprung_mass"]
        self.fg, self.vg = p["guide.coulomb.force"], p["guide.coulomb.velocity"]
        self.strut = Strut(p)
        self.tire = Tire(p, (self.ms + self.mu) * G, (settings or {}).get("tire.lift_off", False))

    def derivative(self, state, u, mode):
        zs, vs, zu, vu = state
        road, road_rate, force = u
        strut = self.strut.force(zs - zu, vs - vu)
        guide = self.fg * math.tanh(vs / self.vg)
        tire = self.tire.force(road - zu, road_rate - vu, mode)
        return [vs, (-strut + force - guide) / self.ms, vu, (strut - force + tire) / self.mu]

    def output(self, state, u, mode):
        zs, vs, zu, vu = state
        road, road_rate, _ = u
        _, body, _, wheel = self.derivative(state, u, mode)
        tire = self.tire.force(road - zu, road_rate - vu, mode)
        return [body, wheel, zs - zu, vs - vu, zu - road, tire]

    def mode(self, state, u):
        return self.tire.mode(u[0] - state[2], u[1] - state[3])

    def guards(self, state, u):
        return self.tire.guards(u[0] - state[2], u[1] - state[3])

    def watched(self, mode):
        return self.tire.watched(mode)

    def after(self, mode, guard, state, u):
        return self.tire.after(mode, guard, u[1] - state[3])

    def energy(self, state, road=0.0):
        """Kinetic energy and the energy of both springs."""
        zs, vs, zu, vu = state
        c, tire = road - zu, self.tire
        return (0.5 * self.ms * vs**2 + 0.5 * self.mu * vu**2 + 0.5 * self.strut.k * (zs - zu)**2
                + 0.5 * tire.kt * c**2 + tire.q * c**3 / 3.0)
