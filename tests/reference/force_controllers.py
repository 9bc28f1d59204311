"""Ajala's force controllers, 3 and 4; z_e = -suspension.deflection, v_m = -V_c w_m / (2 pi A_0).

    ForcePid        F_m = PID(F_ref - F_a),  T_m = V_c / (2 pi A_0) F_m, held within the limit           (Fig. 2a, 24)
    ForceTwoDof     v_ref = -s / (c s + k) F_ref + K_dd z_e - (K_p + K_i / s)(F_ref - F_a)               (33), (36)
                    F_m = -PID(v_ref - v_m)
    ForceTwoDofLpv  the model F = f + D q + D' w, f' = K q + K' w solved for the pump's flow q at F = F_ref, w = K_dd z_e,
                    D = c_k A_k + c_r A_r,  D' = c_k A_k^2 + c_r A_r^2, K and K' alike of kappa p / V    (15), (45), (46)
                    w_ref = 2 pi / V_c q + (K_p + K_i / s)(F_ref - F_a),  T_m = PID(w_ref - w_m)
    K_dd = s (1 - (s / (s + w_c))^n),  w_c = 2 pi f_c                                                    (32), (41), (42)

The sign of K_ss in (36) would be unstable. What the document leaves open is the models' choice: the bilinear transform
throughout; a lag on the derivative; at the torque limit an integral does not take in what would lead beyond it; a
reference is cut to what the limit can hold.
"""

import math

from controllers import Controller
from table import Table, array


def first_order(b, a, period):
    """(b_1 s + b_0) / (a_1 s + a_0) with s = 2 / T (z - 1) / (z + 1), as coefficients of (u_k, u_(k-1), y_(k-1))."""
    (b1, b0), (a1, a0), s = b, a, 2.0 / period
    scale = a1 * s + a0
    return (b1 * s + b0) / scale, (b0 - b1 * s) / scale, (a1 * s - a0) / scale


class Filter:
    """Remembers what of the past enters the next output."""

    def __init__(self, b, a, period):
        self.now, self.before, self.again = first_order(b, a, period)
        self.past = 0.0

    def step(self, u):
        y = self.now * u + self.past
        self.past = self.before * u + self.again * y
        return y


class Pid:
    def __init__(self, p, prefix, limit, period):
        self.proportional, self.limit = p[f"{prefix}.proportional"], limit
        self.integral = Filter((0.0, p[f"{prefix}.integral"]), (1.0, 0.0), period)
        self.derivative = Filter((p[f"{prefix}.derivative"], 0.0), (p[f"{prefix}.derivative_lag"], 1.0), period)

    def step(self, error):
        """Output and what the limit has cut off."""
        past = self.integral.past
        free = self.proportional * error + self.integral.step(error) + self.derivative.step(error)
        held = min(self.limit, max(-self.limit, free))
        if (free - held) * error > 0.0:
            self.integral.past = past
        return held, free - held


class ForceController(Controller):
    """The filters remember; a tick that is only tried out comes first and is forgotten."""

    outputs = ["motor.torque"]

    def __init__(self, parameters, settings):
        self.p, self.settings, self.period = parameters, settings, parameters["period"]

    def tick(self, memory, _state, u, _k):
        if memory is None:
            self.begin(self.p)
        return [self.torque(u)]


class ForcePid(ForceController):
    inputs = ["force_reference", "actuator.force"]

    def begin(self, p):
        self.gear = 2.0 * math.pi * p["piston.area"] / p["pump.displacement"]
        self.pid = Pid(p, "gain", p["torque.limit"] * self.gear, self.period)

    def torque(self, u):
        return self.pid.step(u[0] - u[1])[0] / self.gear


class DisturbanceRate:
    """K_dd, by its definition: w_c (G + ... + G^n) = s (1 - G^n)."""

    def __init__(self, cut_off, order, period):
        self.omega = 2.0 * math.pi * cut_off
        self.chain = [Filter((1.0, 0.0), (1.0, self.omega), period) for _ in range(order)]

    def step(self, u):
        total = 0.0
        for high_pass in self.chain:
            u = high_pass.step(u)
            total += u
        return self.omega * total


class ForceTwoDof(ForceController):
    inputs = ["force_reference", "actuator.force", "suspension.deflection", "motor.speed"]

    def begin(self, p):
        self.gear = 2.0 * math.pi * p["piston.area"] / p["pump.displacement"]
        self.largest = p["torque.limit"] * self.gear
        self.inverse = Filter((1.0, 0.0), (p["plant.damping"], p["plant.stiffness"]), self.period)
        self.disturbance = DisturbanceRate(p["disturbance.cut_off"], self.settings["disturbance.order"], self.period)
        self.integral = Filter((0.0, p["force.integral"]), (1.0, 0.0), self.period)
        self.velocity = Pid(p, "velocity", self.largest, self.period)

    def torque(self, u):
        wanted = min(self.largest, max(-self.largest, u[0]))
        error, past = wanted - u[1], self.integral.past
        reference = (-self.inverse.step(wanted) + self.disturbance.step(-u[2])
                     - self.p["force.proportional"] * error - self.integral.step(error))
        output, excess = self.velocity.step(reference + u[3] / self.gear)
        # The force is -output: with more error it would be still larger.
        if -excess * error > 0.0:
            self.integral.past = past
        return -output / self.gear


class ForceTwoDofLpv(ForceController):
    inputs = ["force_reference", "actuator.force", "suspension.deflection", "suspension.velocity", "motor.speed",
              "pressure.compression", "pressure.rebound"]

    def begin(self, p):
        self.displacement = p["pump.displacement"] / (2.0 * math.pi)
        self.areas = p["piston.compression_area"], p["piston.rebound_area"]
        self.volumes = p["gas.compression_volume"], p["gas.rebound_volume"]
        self.valves = [Table(array(p, f"valve.{side}.flow", 9), array(p, f"valve.{side}.pressure_drop", 9))
                       for side in ("compression", "rebound")]
        self.disturbance = DisturbanceRate(p["disturbance.cut_off"], self.settings["disturbance.order"], self.period)
        self.integral = Filter((0.0, p["force.integral"]), (1.0, 0.0), self.period)
        self.speed = Pid(p, "speed", p["torque.limit"], self.period)
        self.largest = p["torque.limit"] / self.displacement * 0.5 * sum(self.areas)
        self.gas_force = 0.0

    def resistance(self, valve, flow):
        """c = dp / q; at rest that of a small flow."""
        flow = flow if abs(flow) > 1e-9 else 1e-9
        return valve.value(flow, valve.piece(flow)) / flow

    def schedule(self, u):
        """D, D', K and K' of what is measured."""
        p, compressing, pumped = self.p, -u[3], self.displacement * u[4]
        flows = pumped + self.areas[0] * compressing, -pumped - self.areas[1] * compressing
        p0, kappa = p["gas.charge_pressure"], p["gas.exponent"]
        parts = []
        for area, flow, valve, pressure, volume in zip(self.areas, flows, self.valves, u[5:], self.volumes):
            pressure = max(pressure, 0.01 * p0)
            gas = kappa * pressure ** (1.0 + 1.0 / kappa) / (volume * p0 ** (1.0 / kappa))
            resistance = self.resistance(valve, flow)
            parts.append([resistance * area, resistance * area**2, gas * area, gas * area**2])
        return [sum(pair) for pair in zip(*parts)]

    def torque(self, u):
        wanted = min(self.largest, max(-self.largest, u[0]))
        error, past, half = wanted - u[1], self.integral.past, 0.5 * self.period
        damping, damping_w, gas, gas_w = self.schedule(u)
        rate = self.disturbance.step(-u[2])
        # Trapezoidal rule: f_k = gas_force + T / 2 (K q_k + K' w_k).
        flow = (wanted - self.gas_force - (damping_w + half * gas_w) * rate) / (damping + half * gas)
        self.gas_force += self.period * (gas * flow + gas_w * rate)
        reference = flow / self.displacement + self.p["force.proportional"] * error + self.integral.step(error)
        torque, excess = self.speed.step(reference - u[4])
        if excess * error > 0.0:
            self.integral.past = past
        return torque
