"""The eccentric under Kogut's rig, with its motor and its controller; what eq. 15 leaves open is assumed.

Drive:

    u_1 = h - e cos a_0                                                             (15)
    (n^2 J_m + J_e) a_0'' = n k i - F e sin a_0 - T_f tanh(a_0' / w_f),  R i = U d - n k a_0'

d is the duty cycle, held in [-1, 1] in 2^bits - 1 steps to either side; F the tyre's force, which does e sin a_0 = du_1/da_0.

Controller (2.2), T its period, f the wanted frequency, p where a perfect eccentric would be:

    p_k = p_(k-1) + pi T (f_(k-1) + f_k),  kept within a limit of a_0;  p_0 = a_0
    w = 2 pi f + K (p - a_0) - a_0',  d = F 2 pi f + P w + I integral of w + D w'

Bilinear transform; the integral waits while it would lead beyond the limit of d.
"""

import math

from controllers import Controller
from force_controllers import Filter
from integrate import Smooth


class EccentricDrive(Smooth):
    states = ["angle", "speed"]
    inputs = ["duty", "tire.force"]
    outputs = ["height", "velocity", "load.torque", "current", "supply.power"]

    def __init__(self, parameters, settings):
        p = parameters
        self.steps = 2 ** settings.get("pwm.bits", 0) - 1
        self.voltage, self.resistance = p["motor.supply_voltage"], p["motor.resistance"]
        self.constant = p["motor.torque_constant"] * p["gear.ratio"]
        self.inertia = p["gear.ratio"] ** 2 * p["motor.inertia"] + p["eccentric.inertia"]
        self.mean, self.eccentricity = p["eccentric.mean_height"], p["eccentric.eccentricity"]
        self.friction, self.slow = p["eccentric.coulomb.torque"], p["eccentric.coulomb.speed"]

    def electric(self, state, u):
        """Voltage and current."""
        duty = min(1.0, max(-1.0, u[0]))
        duty = round(duty * self.steps) / self.steps if self.steps else duty
        return self.voltage * duty, (self.voltage * duty - self.constant * state[1]) / self.resistance

    def load(self, state, u):
        return u[1] * self.eccentricity * math.sin(state[0])

    def derivative(self, state, u, _mode):
        _, current = self.electric(state, u)
        friction = self.friction * math.tanh(state[1] / self.slow)
        return [state[1], (self.constant * current - self.load(state, u) - friction) / self.inertia]

    def output(self, state, u, _mode):
        voltage, current = self.electric(state, u)
        angle, speed = state
        return [self.mean - self.eccentricity * math.cos(angle), self.eccentricity * math.sin(angle) * speed,
                self.load(state, u), current, voltage * current]


class ExcitationSpeedController(Controller):
    inputs = ["frequency_reference", "eccentric.angle", "eccentric.speed"]
    outputs = ["duty"]

    def __init__(self, parameters, _settings=None):
        self.p, self.period = parameters, parameters["period"]

    def tick(self, memory, _state, u, _k):
        p, (wanted, angle, speed) = self.p, u
        if memory is None:
            self.ahead, self.before = angle, wanted
            self.integral = Filter((0.0, p["velocity.integral"]), (1.0, 0.0), self.period)
            self.derivative = Filter((p["velocity.derivative"], 0.0), (p["velocity.derivative_filter"], 1.0),
                                     self.period)
        else:
            self.ahead += math.pi * self.period * (self.before + wanted)
        self.before, reach = wanted, p["position.limit"]
        self.ahead = min(angle + reach, max(angle - reach, self.ahead))
        turning = 2.0 * math.pi * wanted
        missing = turning + p["position.gain"] * (self.ahead - angle) - speed
        past = self.integral.past
        free = (p["velocity.feedforward"] * turning + p["velocity.proportional"] * missing
                + self.integral.step(missing) + self.derivative.step(missing))
        duty = min(p["duty_limit"], max(-p["duty_limit"], free))
        if (free - duty) * missing > 0.0:
            self.integral.past = past
        return [duty]
