"""The linear motor below the wheel, TUM 3.2.1, Fig. 4-7 and eq. 1. What the figures leave open is the model's choice.

    command   c = command.position less the dead zone, held within the stroke
    target    r'' = p^2 (c - r) - 2 p r'
    profile   s'' = r'' + 2 p (r' + a(r - s) - s'), held within the acceleration limit; as s' nears its limit l, held
              within 2 p (-l - s') and 2 p (l - s').  a(e) = sign(e) (sqrt(2 b |e| + d^2) - d), b = 0.8 of the
              acceleration limit, d = 2 b / p: the velocity from which it can still brake
    velocity  v_c = k_v s' + k_a s'' + k_x (s - x), held within the speed limit, then a lag; PI, held within the
              current limit, then a lag
    current   i_c = i_v + (command.force + offset) / k_f, held within the current limit; PI, held within the voltage
    PI        k_p e + I,  I' = k_i e + k_i / k_p (what is held - what is not)
    motor     L i' = u - R i - k_f v,  m v' = k_f i - k x - d v - F_c tanh(v / v_0) - F_const + load - wheel
    overload  q' = i^2 - i_c^2 between 0 and Q = (i_p^2 - i_c^2) t_p
              current limit i_c + (i_p - i_c) clamp((Q - q) / (fade Q), 0, 1)
"""

import math

from pieces import Pieced


class ExcitationMotor(Pieced):
    states = ["position", "velocity", "current", "overload", "target.position", "target.velocity", "profile.position",
              "profile.velocity", "velocity_loop.command", "velocity_loop.integrator", "velocity_loop.output",
              "current_loop.integrator"]
    inputs = ["command.position", "command.force", "command.voltage", "load.force", "wheel.force"]
    outputs = ["acceleration", "force", "voltage", "power", "following_error", "stroke.reserve", "speed.reserve"]

    max_step = 1e-4

    def __init__(self, parameters, settings):
        self.p, self.drive = parameters, settings["drive"]
        p = parameters
        self.capacity = (p["peak_current"] ** 2 - p["continuous_current"] ** 2) * p["peak_time"]

    def current_limit(self, q, pieces):
        p = self.p
        share = pieces.clamp((self.capacity - q) / (p["fade"] * self.capacity), 0.0, 1.0)
        return p["continuous_current"] + (p["peak_current"] - p["continuous_current"]) * share

    def overload(self, q, current, pieces):
        surplus = current**2 - self.p["continuous_current"] ** 2
        # An empty one can only grow, a full one only fall: guards that do not stay at zero there.
        may_fall = pieces.positive(q if q > 0.0 else surplus)
        may_grow = pieces.positive(self.capacity - q if q < self.capacity else -surplus)
        return surplus if may_fall and may_grow else 0.0

    @staticmethod
    def regulated(proportional, integral, error, content, limit, pieces):
        """Output of a PI controller and the rate of its integral part."""
        free = proportional * error + content
        held = pieces.clamp(free, -limit, limit)
        return held, integral * error + integral / proportional * (held - free)

    def profile(self, r, dr, ddr, s, ds, pieces):
        p, pole = self.p, self.p["profile.pole"]
        most, fastest = p["profile.acceleration_limit"], p["profile.velocity_limit"]
        braking = 0.8 * most
        # No guard where r - s changes its sign: the slope is continuous there, and within the limits it stays zero.
        rounding = 2.0 * braking / pole
        approach = math.copysign(math.sqrt(2.0 * braking * abs(r - s) + rounding**2) - rounding, r - s)
        low = pieces.clamp(2.0 * pole * (-fastest - ds), -most, most)
        high = pieces.clamp(2.0 * pole * (fastest - ds), -most, most)
        return pieces.clamp(ddr + 2.0 * pole * (dr + approach - ds), low, high)

    def cascade(self, state, command, limit, pieces):
        """Rates of target, profile and velocity loop."""
        p = self.p
        x, v, _, _, r, dr, s, ds, filtered, integrator, output, _ = state
        command -= pieces.clamp(command, -p["dead_zone"], p["dead_zone"])
        command = pieces.clamp(command, -p["stroke_limit"], p["stroke_limit"])
        pole = p["profile.pole"]
        ddr = pole**2 * (command - r) - 2.0 * pole * dr
        dds = self.profile(r, dr, ddr, s, ds, pieces)
        wanted = p["feed_forward.velocity"] * ds + p["feed_forward.acceleration"] * dds
        wanted += p["position_loop.gain"] * (s - x)
        wanted = pieces.clamp(wanted, -p["speed_limit"], p["speed_limit"])
        demanded, rate = self.regulated(p["velocity_loop.proportional"], p["velocity_loop.integral"],
                                        filtered - v, integrator, limit, pieces)
        lag_in, lag_out = (2.0 * math.pi * p[f"velocity_loop.{name}_filter"] for name in ("command", "output"))
        return [dr, ddr, ds, dds, lag_in * (wanted - filtered), rate, lag_out * (demanded - output)]

    def law(self, state, u, pieces):
        p = self.p
        x, v, i, q = state[:4]
        k_f = p["force_constant"]
        # Before everything that depends on the drive: `settle` knows their places among the guards.
        limit, surplus = self.current_limit(q, pieces), self.overload(q, i, pieces)
        rates, demanded, settling = [0.0] * 7, 0.0, 0.0
        if self.drive == "Position":
            rates, demanded = self.cascade(state, u[0], limit, pieces), state[10]
        if self.drive == "Voltage":
            voltage = pieces.clamp(u[2], -p["voltage_limit"], p["voltage_limit"])
        else:
            demanded = pieces.clamp(demanded + (u[1] + p["force_offset"]) / k_f, -limit, limit)
            voltage, settling = self.regulated(p["current_loop.proportional"], p["current_loop.integral"],
                                               demanded - i, state[11], p["voltage_limit"], pieces)
        friction = p["guide.coulomb.force"] * math.tanh(v / p["guide.coulomb.velocity"])
        force = k_f * i - p["base_spring.stiffness"] * x - p["guide.damping"] * v - friction
        acceleration = (force - p["constant_load"] + u[3] - u[4]) / p["moving_mass"]
        current = (voltage - p["resistance"] * i - k_f * v) / p["inductance"]
        return ([v, acceleration, current, surplus, *rates, settling],
                [acceleration, k_f * i, voltage, voltage * i, u[0] - x, p["stroke_limit"] - abs(x),
                 p["speed_limit"] - abs(v)])

    def settle(self, state, mode):
        """An accumulator that is empty is so exactly."""
        return state if mode[2] else [*state[:3], 0.0, *state[4:]]

    @property
    def guard_count(self):
        return len(self.guards([0.0] * len(self.states), [0.0] * len(self.inputs)))
