"""A linear positioning drive.

    m x'' = F - s - g - F_0 + load,   F = force, or gain times command; or x, x', x'' are given and F is sought
    s = k x + k_2 x^2 + k_3 x^3
    g = d x' + [F_c + F_b exp(-(x'/v_s)^2)] tanh(x'/v_0) + A sin(2 pi x/p + phi) + s curve(x')

The curve's points are guards, so that the equations are smooth within a mode.
"""

import math

from effects import Curve
from integrate import Switched


class LinearDrive(Switched):
    states = ["carriage.position", "carriage.velocity"]
    inputs = ["force", "command", "load.force", "motion.position", "motion.velocity", "motion.acceleration"]
    outputs = ["acceleration", "resistance", "position", "velocity", "motor.force"]

    def __init__(self, parameters, settings):
        self.p = parameters
        self.drive = settings.get("drive", "Force")
        self.curve = Curve(parameters, "guide.curve", "velocity")

    def guards(self, state, u):
        return self.curve.guards(self.motion(state, u)[1])

    def motion(self, state, u):
        return u[3:5] if self.drive == "Motion" else state

    def resistance(self, state, mode):
        get = lambda name, otherwise=0.0: self.p.get(name, otherwise)
        x, v = state
        friction = get("guide.coulomb.force") + get("guide.stribeck.force") * math.exp(
            -(v / get("guide.stribeck.velocity", 0.01)) ** 2)
        cogging = get("guide.cogging.force") * math.sin(
            2.0 * math.pi * x / get("guide.cogging.period", 1.0) + get("guide.cogging.phase"))
        return (get("guide.damping") * v + friction * math.tanh(v / get("guide.coulomb.velocity", 0.008)) + cogging
                + self.curve.force(v, mode))

    def held(self, state, u, mode):
        """The force against the carriage beside its inertia."""
        get = lambda name: self.p.get(name, 0.0)
        motion = self.motion(state, u)
        rates = [get("ground_spring.stiffness"), get("ground_spring.progression.quadratic"), get("ground_spring.progression.cubic")]
        spring = sum(rate * motion[0] ** (power + 1) for power, rate in enumerate(rates))
        return spring + get("constant_load") + self.resistance(motion, mode) - u[2]

    def driven(self, state, u, mode):
        """Acceleration and the motor's force."""
        if self.drive == "Motion":
            return u[5], self.p["moving_mass"] * u[5] + self.held(state, u, mode)
        force = self.p["amplifier.gain"] * u[1] if self.drive == "Command" else u[0]
        return (force - self.held(state, u, mode)) / self.p["moving_mass"], force

    def derivative(self, state, u, mode):
        return [self.motion(state, u)[1], self.driven(state, u, mode)[0]]

    def output(self, state, u, mode):
        acceleration, force = self.driven(state, u, mode)
        motion = self.motion(state, u)
        return [acceleration, self.resistance(motion, mode), *motion, force]


class RotaryDrive(LinearDrive):
    """The same about an axis: torques for forces."""
    states = ["shaft.position", "shaft.velocity"]
    inputs = ["torque", "command", "load.torque", "motion.position", "motion.velocity", "motion.acceleration"]
    outputs = ["acceleration", "resistance", "position", "velocity", "motor.torque"]

    def __init__(self, parameters, settings):
        drives = {"Torque": "Force", "Command": "Command", "Motion": "Motion"}
        super().__init__({"moving_mass": parameters["inertia"], **parameters},
                         {"drive": drives[settings.get("drive", "Torque")]})
