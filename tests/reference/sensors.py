"""Instrumentation without its noise, TUM 3.1, 3.5 and Kogut 2.1, and a velocity from an acceleration.

Sampled: what a tick reads is held until the next.

An analogue channel, in volts, S the sensitivity:

    Direct       y = S x
    FirstOrder   y' = w_b (S x - y),  w_b = 2 pi bandwidth
    SecondOrder  y'' = w^2 (S x - y) - 2 d w y',  w from |y / (S x)|^2 = 1/2 at w_b
    sensor       u = (1 + e) y + u_0, held within the full scale
    filter       f' = 2 pi f_c (u - f), or f = u without
    converter    q round(((1 + e_c) f + u_c) / q) between -range and range - q; without steps no rounding
    reading      that over S

An encoder: floor(n (x - x_0)(1 + e)) / n + x_0, or the nearest.
"""

import math

from integrate import Switched


def clamp(value, low, high):
    return min(high, max(low, value))


class Channel:
    def __init__(self, parameters, name, dynamics, filtered):
        def p(part):
            return parameters[f"{name}.{part}"]
        assert p("noise") == 0.0, "the references have no noise"
        self.sensitivity, self.dynamics, self.filtered = p("sensitivity"), dynamics, filtered
        corner, d = 2.0 * math.pi * p("sensor.bandwidth"), p("sensor.damping")
        self.rate, self.damping = corner, d
        # (1 - r^2)^2 + (2 d r)^2 = 2 with r = w_b / w.
        self.natural = corner / math.sqrt(1.0 - 2.0 * d * d + math.sqrt((1.0 - 2.0 * d * d) ** 2 + 1.0))
        self.full_scale, self.gain = p("sensor.full_scale"), 1.0 + p("sensor.gain_error")
        self.offset = p("sensor.offset")
        self.corner = 2.0 * math.pi * p("filter.corner_frequency")
        self.range, self.step = p("converter.range"), p("converter.resolution")
        self.converter_gain, self.converter_offset = 1.0 + p("converter.gain_error"), p("converter.offset")

    def free(self, x, state):
        """What the sensor would give without its limit."""
        y = self.sensitivity * x if self.dynamics == "Direct" else state[0]
        return self.gain * y + self.offset

    def sensed(self, x, state):
        return clamp(self.free(x, state), -self.full_scale, self.full_scale)

    def rates(self, x, state, mode):
        y, trend, filtered = state
        aim, above, below = self.sensitivity * x, *mode
        if self.dynamics == "SecondOrder":
            rates = [self.natural * trend, self.natural * (aim - y - 2.0 * self.damping * trend)]
        else:
            rates = [self.rate * (aim - y), 0.0] if self.dynamics == "FirstOrder" else [0.0, 0.0]
        u = self.full_scale if above else -self.full_scale if below else self.free(x, state)
        return rates + [self.corner * (u - filtered) if self.filtered else 0.0]

    def guards(self, x, state):
        u = self.free(x, state)
        return [u - self.full_scale, -self.full_scale - u]

    def reading(self, x, state):
        voltage = state[2] if self.filtered else self.sensed(x, state)
        voltage = self.converter_gain * voltage + self.converter_offset
        if self.step:
            voltage = self.step * math.floor(voltage / self.step + 0.5)
        return clamp(voltage, -self.range, self.range - self.step) / self.sensitivity


def counted(density, gain_error, zero, rounding, x):
    if density == 0.0:
        return (x - zero) * (1.0 + gain_error) + zero
    counts = density * (x - zero) * (1.0 + gain_error)
    return math.floor(counts + (0.5 if rounding == "Nearest" else 0.0)) / density + zero


class Sampled(Switched):
    """Its outputs are its memory."""

    def output(self, _state, u, _mode):
        return u[len(self.inputs):]


class SensorChain(Sampled):
    analog = ["body_acceleration", "wheel_acceleration", "wheel_force", "actuator_current"]
    encoders = ["suspension_deflection", "road_position"]
    states = [f"{name}.{part}" for name in analog for part in ("sensor", "trend", "filtered")]
    inputs = ["body.acceleration", "wheel.acceleration", "wheel.force", "actuator.current", "suspension.deflection",
              "road.position"]
    outputs = [f"measured.{name}" for name in inputs]
    guard_count = 2 * len(analog)
    shown = False

    def __init__(self, parameters, settings):
        self.period, self.rounding = parameters["period"], settings["encoder.rounding"]
        self.channels = [Channel(parameters, name, settings[f"{name}.dynamics"], settings["filter.enabled"])
                         for name in self.analog]
        self.scales = [[parameters[f"{name}.{part}"] for part in ("density", "gain_error", "zero")]
                       for name in self.encoders]

    def each(self, state, u):
        return [(channel, u[i], state[3 * i:3 * i + 3]) for i, channel in enumerate(self.channels)]

    def derivative(self, state, u, mode):
        return [rate for i, (channel, x, own) in enumerate(self.each(state, u))
                for rate in channel.rates(x, own, mode[2 * i:2 * i + 2])]

    def guards(self, state, u):
        return [guard for channel, x, own in self.each(state, u) for guard in channel.guards(x, own)]

    def tick(self, _memory, state, u, _k):
        analog = [channel.reading(x, own) for channel, x, own in self.each(state, u)]
        return analog + [counted(*scale, self.rounding, x) for scale, x in zip(self.scales, u[4:])]


class AngleSensorChain(Sampled):
    """Three encoders; w_k = (tau w_(k-1) + a_k - a_(k-1)) / (tau + T), zero at the first sample. The body arm against
    the frame is the sum of the other two."""

    encoders = ["eccentric", "wheel_arm", "relative"]
    inputs = ["eccentric.angle", "wheel_arm.angle", "body_arm.angle"]
    outputs = [f"measured.{name}.{what}" for name in [*encoders, "body_arm"] for what in ("angle", "speed")]

    def __init__(self, parameters, settings):
        self.period, self.tau = parameters["period"], parameters["speed_filter"]
        self.rounding = settings["encoder.rounding"]
        self.scales = [(parameters[f"{name}.counts_per_turn"] / (2.0 * math.pi), parameters[f"{name}.zero"])
                       for name in self.encoders]

    def tick(self, memory, _state, u, _k):
        eccentric, wheel, body = u
        readings = []
        for i, ((density, zero), angle) in enumerate(zip(self.scales, (eccentric, wheel, body - wheel))):
            angle = counted(density, 0.0, zero, self.rounding, angle)
            before, speed = memory[2 * i:2 * i + 2] if memory else (angle, 0.0)
            readings += [angle, (self.tau * speed + angle - before) / (self.tau + self.period)]
        return readings + [readings[2] + readings[4], readings[3] + readings[5]]


class VelocityEstimator(Sampled):
    """v / a = s / ((s + w_h)(s + w_l)) by the bilinear transform: a high-pass filter s / (s + w_h), then the rest.

    The memory ends with what the output does not show."""

    inputs = ["body.acceleration"]
    outputs = ["body.velocity"]

    def __init__(self, parameters, _settings=None):
        self.period = parameters["period"]
        self.leak, self.pass_ = (2.0 * math.pi * parameters[f"{name}_frequency"] for name in ("leak", "high_pass"))

    def tick(self, memory, _state, u, _k):
        velocity, acceleration, passed = memory or (0.0, 0.0, 0.0)
        s = 2.0 / self.period
        now = (s * (u[0] - acceleration) + (s - self.pass_) * passed) / (s + self.pass_)
        return [(now + passed + (s - self.leak) * velocity) / (s + self.leak), u[0], now]

    def output(self, _state, u, _mode):
        return u[1:2]


class SignalAdapter(Sampled):
    """y = factor x + offset + added, of the signal, its backward difference, its integral by the trapezoidal rule, or its lag by
    the backward Euler method."""

    inputs, outputs = ["input", "added"], ["output"]

    def __init__(self, parameters, settings):
        self.period, self.filter, self.initial = (parameters[name] for name in ("period", "filter", "initial"))
        self.factor, self.offset = parameters["factor"], parameters["offset"]
        self.shown_part = {"Value": 0, "Derivative": 3, "Integral": 4, "Lag": 5}[settings["operation"]]

    def tick(self, memory, _state, u, _k):
        if not memory:
            return [u[0], 0.0, self.initial, u[0]]
        before, rate, integral, lagged = memory
        return [u[0], (self.filter * rate + u[0] - before) / (self.filter + self.period),
                integral + 0.5 * self.period * (u[0] + before),
                lagged + self.period / (self.filter + self.period) * (u[0] - lagged)]

    def output(self, _state, u, _mode):
        return [self.factor * u[self.shown_part] + self.offset + u[1]]
