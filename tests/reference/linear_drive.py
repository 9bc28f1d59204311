"""A linear positioning drive.

    m x'' = F - k x - g - F_0 + load,   F = force, or gain times command
    g = d x' + [F_c + F_b exp(-(x'/v_s)^2)] tanh(x'/v_0) + A sin(2 pi x/p + phi) + s curve(x')

The curve's points are guards, so that the equations are smooth within a mode.
"""

import math

from effects import Curve
from integrate import Switched


class LinearDrive(Switched):
    states = ["position", "velocity"]
    inputs = ["force", "command", "load.force"]
    outputs = ["acceleration", "resistance"]

    def __init__(self, parameters, settings):
        self.p = parameters
        self.commanded = settings.get("drive") == "Command"
        self.curve = Curve(parameters, "guide.curve", "velocity")

    def guards(self, state, _u):
        return self.curve.guards(state[1])

    def resistance(self, state, mode):
        get = lambda name, otherwise=0.0: self.p.get(name, otherwise)
        x, v = state
        friction = get("guide.coulomb.force") + get("guide.stribeck.force") * math.exp(
            -(v / get("guide.stribeck.velocity", 0.01)) ** 2)
        cogging = get("guide.cogging.force") * math.sin(
            2.0 * math.pi * x / get("guide.cogging.period", 1.0) + get("guide.cogging.phase"))
        return (get("guide.damping") * v + friction * math.tanh(v / get("guide.coulomb.velocity", 0.008)) + cogging
                + self.curve.force(v, mode))

    def acceleration(self, state, u, mode):
        driven = self.p["amplifier.gain"] * u[1] if self.commanded else u[0]
        held = self.p.get("ground_spring.stiffness", 0.0) * state[0] + self.p.get("constant_load", 0.0)
        return (driven + u[2] - held - self.resistance(state, mode)) / self.p["moving_mass"]

    def derivative(self, state, u, mode):
        return [state[1], self.acceleration(state, u, mode)]

    def output(self, state, u, mode):
        return [self.acceleration(state, u, mode), self.resistance(state, mode)]
