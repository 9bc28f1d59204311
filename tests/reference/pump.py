"""The pump actuator, Ajala 2; v = suspension.velocity = -z_e'.

Nonlinear, eq. 1-16, with overpressures e = p - p_0 as states:

    q_k = V_c w / 2 pi - A_k v - L,  q_r = -V_c w / 2 pi + A_r v + L    (5), (9)
    p' = kappa q p / V,  V = V_0 (p_0 / p)^(1 / kappa)                  (2), (3), (46)
    p_k = p_ks + dp_k(q_k),  p_r = p_rs + dp_r(q_r)                     (7), (8)
    J w' = T - V_c / 2 pi (p_k - p_r) - T_f tanh(w / w_f),  F_a = A_k p_k - A_r p_r  (4), (6)

with the leak L = C_l (p_k - p_r), where p_k and p_r are those of L = 0. The mode is a piece of each valve's table,
and with a leak before these a piece of each for the flow without it.

Linear, eq. 18. A locked pump keeps its speed, whatever the torque.
"""

import math

from integrate import Smooth
from table import Table, array

POINTS = 9


class PumpHydraulicActuator(Smooth):
    states = ["motor.speed", "overpressure.compression", "overpressure.rebound"]
    inputs = ["motor.torque", "suspension.velocity"]
    outputs = ["force", "total_force", "pressure.compression", "pressure.rebound",
               "chamber.compression", "chamber.rebound", "motor.power"]
    def __init__(self, parameters, settings):
        p = parameters
        self.locked = settings.get("pump.locked", False)
        self.displacement, self.inertia = p["pump.displacement"] / (2.0 * math.pi), p["motor.inertia"]
        self.ak, self.ar = p["piston.compression_area"], p["piston.rebound_area"]
        self.p0, self.kappa = p["gas.charge_pressure"], p["gas.exponent"]
        self.vk, self.vr = p["gas.compression_volume"], p["gas.rebound_volume"]
        self.valves = [Table(array(p, f"valve.{side}.flow", POINTS), array(p, f"valve.{side}.pressure_drop", POINTS))
                       for side in ("compression", "rebound")]
        self.leakage = p.get("pump.leakage", 0.0)
        self.friction, self.turning_over = p.get("pump.coulomb.torque", 0.0), p.get("pump.coulomb.speed", 1.0)
        # One table for each flow that counts.
        self.tables = self.valves * (2 if self.leakage else 1)
        self.guard_count = len(self.tables) * (POINTS - 2)

    def flows(self, state, u, mode=None):
        """Through the valves; with a leak, those without it come first. Without a mode a piece is where its flow is."""
        pumped, v = self.displacement * state[0], u[1]
        tight = [pumped - self.ak * v, -pumped + self.ar * v]
        if not self.leakage:
            return tight
        pieces = [valve.piece(q) for valve, q in zip(self.valves, tight)] if mode is None else mode[:2]
        pk, pr = (e + valve.value(q, piece) for e, q, valve, piece in zip(state[1:], tight, self.valves, pieces))
        leak = self.leakage * (pk - pr)
        return [*tight, tight[0] - leak, tight[1] + leak]

    def pressures(self, state, u, mode):
        """Flows, gas pressures and pressures on the piston."""
        flows = self.flows(state, u, mode)[-2:]
        gas = [self.p0 + state[1], self.p0 + state[2]]
        pieces = mode[-2:]
        return flows, gas, [p + valve.value(q, piece) for p, q, valve, piece in zip(gas, flows, self.valves, pieces)]

    def derivative(self, state, u, mode):
        flows, gas, (pk, pr) = self.pressures(state, u, mode)
        rates = [self.kappa * q * p / (v0 * (self.p0 / p) ** (1.0 / self.kappa))
                 for q, p, v0 in zip(flows, gas, (self.vk, self.vr))]
        friction = self.friction * math.tanh(state[0] / self.turning_over)
        turning = 0.0 if self.locked else (u[0] - self.displacement * (pk - pr) - friction) / self.inertia
        return [turning, *rates]

    def output(self, state, u, mode):
        _, gas, (pk, pr) = self.pressures(state, u, mode)
        total = self.ak * pk - self.ar * pr
        return [total - (self.ak - self.ar) * self.p0, total, *gas, pk, pr, u[0] * state[0]]

    def mode(self, state, u):
        return tuple(table.piece(q) for table, q in zip(self.tables, self.flows(state, u)))

    def guards(self, state, u):
        return [guard for table, q in zip(self.tables, self.flows(state, u)) for guard in table.guards(q)]

    def watched(self, mode):
        return [(number * (POINTS - 2) + index, direction)
                for number, (table, piece) in enumerate(zip(self.tables, mode))
                for index, direction in table.watched(piece)]

    def after(self, mode, guard, _state, _u):
        number, guard = divmod(guard, POINTS - 2)
        return tuple(table.after(piece, guard) if index == number else piece
                     for index, (table, piece) in enumerate(zip(self.tables, mode)))

    def gas_energy(self, state):
        """What the gas holds above its content at rest, pressures counting from p_0."""
        energy = 0.0
        for e, v0 in zip(state[1:], (self.vk, self.vr)):
            p = self.p0 + e
            v = v0 * (self.p0 / p) ** (1.0 / self.kappa)
            # The integral of p dV of a polytropic gas, from v to v0, less that of p_0.
            energy += (p * v - self.p0 * v0) / (self.kappa - 1.0) - self.p0 * (v0 - v)
        return energy


class PumpHydraulicActuatorLinear(Smooth):
    states = ["motor.speed", "pressure.difference"]
    inputs = ["motor.torque", "suspension.velocity"]
    outputs = ["force", "motor.power"]

    def __init__(self, parameters, settings):
        p = parameters
        self.locked = settings.get("pump.locked", False)
        vc, self.j, self.a0 = p["pump.displacement"] / (2.0 * math.pi), p["motor.inertia"], p["piston.area"]
        self.vc, self.c = vc, p["valve.compression_resistance"] + p["valve.rebound_resistance"]
        self.gas = p["gas.exponent"] * p["gas.charge_pressure"] * (
            1.0 / p["gas.compression_volume"] + 1.0 / p["gas.rebound_volume"])
        # Eq. 25.
        self.mass, self.stiffness = (self.a0 / vc) ** 2 * self.j, self.a0**2 * self.gas
        self.damping = self.a0**2 * self.c

    def derivative(self, state, u, _mode):
        speed, difference = state
        torque, compressing = u[0], -u[1]
        vc, j, a0, c = self.vc, self.j, self.a0, self.c
        # Rows of eq. 18b.
        turning = -vc / j * difference - vc**2 * c / j * speed - vc * a0 * c / j * compressing + torque / j
        return [0.0 if self.locked else turning, self.gas * (vc * speed + a0 * compressing)]

    def output(self, state, u, _mode):
        speed, difference = state
        force = self.a0 * difference + self.vc * self.a0 * self.c * speed + self.a0**2 * self.c * -u[1]
        return [force, u[0] * speed]
