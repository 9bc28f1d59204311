"""The rig of AGH with its servohydraulic actuator, Konieczny 2 and 3.

    f_s = A_a P_r,  P_r' = alpha (Q - A_a v - C_tm P_r),  alpha = 4 E / (V_t + V_p)      (2.3)-(2.12)
    tau u_1' = k_sv v_c - u_1,  |k_sv v_c| held within the stroke                         (2.13)
    Nonlinear   Q = u_1 l C_d sqrt((P_z - sign(u_1) P_r) / rho)                           (2.9)
    Linear      Q = u_1 l C_d sqrt(P_z / rho)                                             (2.23)
    Regression  Q = g u_1 - c P_r                                                         (2.24)
    supply      Q_z = sign(u_1) Q, in the regression g |u_1| (left open; so it is continuous); power P_z Q_z

Where the root of (2.9) ends: with s = P_z - sign(u_1) P_r, sqrt(s) becomes s / sqrt(p_lam) within |s| < p_lam and
-sqrt(-s) below.

With load.mass m > 0 the actuator works for a master that holds v and f_s in steps of T: at t_k = k T it takes

    a_k = (a_(k-1) + (v_k - v_(k-1)) / T - f_(k-1) / m) / 2,  a_0 = 0;  f_k, the force that it has just shown

and until t_(k+1) it works with v + c, c = T (f_k / m + a_k) / 2, and shows A_a P, the solution (linear in P) of

    P = P_r + T/2 alpha (Q(P_r) - A_a (v_k + 2 c + T/2 (A_a P / m + a_k)) - C_tm P);  v_k + 2 c is v_0 for f_0.

Body and wheel, (2.14) and (2.15), with the tyre's damper integrated as in (2.16): q = z_1' + b_1 (z_1 - w) / m_1, so
that the road's velocity is needed for the wheel's load only:

    m_2 z_2'' = f_s - F_strut - F_guide,  m_1 q' = F_strut - f_s + k_1 c + q_t c^2 + F_t tanh(c' / v_t),  c = w - z_1
"""

import math

import numpy as np

from corner import Strut
from integrate import Smooth, Switched


class Actuator:
    """Cylinder and valve; the side of each guard says which piece of the root holds."""

    guard_count = 5

    def __init__(self, parameters, law, prefix=""):
        def p(name):
            return parameters[prefix + name]
        self.law, self.supply, self.laminar = law, p("supply.pressure"), p("valve.laminar_pressure")
        self.area, self.leakage = p("cylinder.area"), p("cylinder.leakage")
        self.alpha = 4.0 * p("fluid.bulk_modulus") / (p("cylinder.volume") + p("cylinder.hose_volume"))
        self.opening = p("valve.perimeter") * p("valve.discharge_coefficient") / math.sqrt(p("fluid.density"))
        self.plane = p("valve.regression.flow_gain"), p("valve.regression.pressure_coefficient")
        self.gain, self.tau, self.stroke = p("spool.gain"), p("spool.time_constant"), p("spool.stroke")

    def guards(self, pressure, spool):
        """The spool's side; the pressure drop beyond the laminar range on either side of nothing, for either side."""
        return [spool, *(drop - edge for drop in (self.supply - pressure, self.supply + pressure)
                         for edge in (-self.laminar, self.laminar))]

    def flow(self, pressure, spool, mode):
        if self.law == "Linear":
            return spool * self.opening * math.sqrt(self.supply)
        if self.law == "Regression":
            return self.plane[0] * spool - self.plane[1] * pressure
        positive = mode[0]
        drop = self.supply - pressure if positive else self.supply + pressure
        forwards, turbulent = mode[1:3] if positive else mode[3:5]
        if turbulent:
            root = math.sqrt(max(drop, 0.0))
        else:
            root = drop / math.sqrt(self.laminar) if forwards else -math.sqrt(max(-drop, 0.0))
        return spool * self.opening * root

    def rates(self, pressure, spool, voltage, velocity, mode):
        flow = self.flow(pressure, spool, mode)
        aim = min(self.stroke, max(-self.stroke, self.gain * voltage))
        return self.alpha * (flow - self.area * velocity - self.leakage * pressure), (aim - spool) / self.tau

    def from_supply(self, pressure, spool, mode):
        if self.law == "Regression":
            flow = self.plane[0] * abs(spool)
        else:
            flow = self.flow(pressure, spool, mode) * (1.0 if mode[0] else -1.0)
        return [flow, self.supply * flow]


class ServoHydraulicActuator(Switched):
    states = ["pressure", "spool.position"]
    inputs = ["voltage", "suspension.velocity"]
    outputs = ["force", "supply.flow", "supply.power"]
    guard_count = Actuator.guard_count

    def __init__(self, parameters, settings):
        self.actuator = Actuator(parameters, settings["law"])
        self.mass, interval = parameters.get("load.mass", 0.0), parameters.get("load.interval", 0.0)
        self.period = interval if self.mass else None

    def guards(self, state, _u):
        return self.actuator.guards(*state)

    def half_gain(self, memory):
        """c; memory is v_k, f_k, a_k."""
        return 0.5 * self.period * (memory[1] / self.mass + memory[2])

    def shown_force(self, state, velocity, other, mode):
        act, half = self.actuator, 0.5 * self.period
        # p = r + s p.
        r = state[0] + half * act.alpha * (act.flow(*state, mode) - act.area * (velocity + half * other))
        s = -half * act.alpha * (half * act.area**2 / self.mass + act.leakage)
        return act.area * r / (1.0 - s)

    def tick(self, memory, state, u, _k):
        velocity, mode = u[1], self.mode(state, u)
        if memory is None:
            return [velocity, self.shown_force(state, velocity, 0.0, mode), 0.0]
        before, force, other = memory
        shown = self.shown_force(state, before + 2.0 * self.half_gain(memory), other, mode)
        return [velocity, shown, 0.5 * (other + (velocity - before) / self.period - force / self.mass)]

    def watched(self, mode):
        # The other laws have no kinks but that of the supply's flow, which moves nothing.
        return super().watched(mode) if self.actuator.law == "Nonlinear" else []

    def before(self, _state, u):
        # The force that the first tick takes: with the velocity of the start.
        return [u[1], 0.0, 0.0]

    def derivative(self, state, u, mode):
        voltage, velocity, *memory = u
        velocity += self.half_gain(memory) if memory else 0.0
        return list(self.actuator.rates(*state, voltage, velocity, mode))

    def output(self, state, u, mode):
        memory = u[len(self.inputs):]
        if not memory:
            force = self.actuator.area * state[0]
        else:
            force = self.shown_force(state, memory[0] + 2.0 * self.half_gain(memory), memory[2], mode)
        return [force, *self.actuator.from_supply(*state, mode)]


class ServoSuspension(Switched):
    states = ["body.position", "body.velocity", "wheel.position", "wheel.undamped_velocity", "pressure",
              "spool.position"]
    inputs = ["voltage", "road.position", "road.velocity"]
    outputs = ["body.acceleration", "wheel.velocity", "wheel.acceleration", "wheel.force", "suspension.deflection",
               "suspension.velocity", "tire.deflection", "actuator.force", "supply.flow", "supply.power"]
    guard_count = Actuator.guard_count

    def __init__(self, parameters, settings):
        p = parameters
        self.m2, self.m1 = p["sprung_mass"], p["unsprung_mass"]
        self.fg, self.vg = p["guide.coulomb.force"], p["guide.coulomb.velocity"]
        self.strut = Strut(p)
        self.k1, self.b1, self.q1 = p["tire.stiffness"], p["tire.damping"], p["tire.quadratic"]
        self.ft, self.vt = p["tire.coulomb.force"], p["tire.coulomb.velocity"]
        self.actuator = Actuator(p, settings["actuator.law"], "actuator.")

    def guards(self, state, _u):
        return self.actuator.guards(*state[4:])

    def watched(self, mode):
        return super().watched(mode) if self.actuator.law == "Nonlinear" else []

    def forces(self, state, u):
        """Of strut and actuator; the tyre's but for its damper; the wheel's velocity."""
        z2, v2, z1, q, pressure, _ = state
        wheel = q - self.b1 / self.m1 * (z1 - u[1])
        strut = self.strut.force(z2 - z1, v2 - wheel)
        c = u[1] - z1
        friction = self.ft * math.tanh((u[2] - wheel) / self.vt) if self.ft else 0.0
        return strut, self.actuator.area * pressure, self.k1 * c + self.q1 * c * c + friction, wheel

    def derivative(self, state, u, mode):
        strut, actuator, tire, wheel = self.forces(state, u)
        guide = self.fg * math.tanh(state[1] / self.vg)
        pressure, spool = self.actuator.rates(state[4], state[5], u[0], state[1] - wheel, mode)
        return [state[1], (actuator - strut - guide) / self.m2, wheel, (strut - actuator + tire) / self.m1,
                pressure, spool]

    def output(self, state, u, mode):
        strut, actuator, tire, wheel = self.forces(state, u)
        load = tire + self.b1 * (u[2] - wheel)
        return [self.derivative(state, u, mode)[1], wheel, (strut - actuator + load) / self.m1, load,
                state[0] - state[2], state[1] - wheel, state[2] - u[1], actuator,
                *self.actuator.from_supply(state[4], state[5], mode)]


def phenomenological(p):
    """A and B of Konieczny eq. 2.17, row 6 with the zero that is missing in print; inputs v, w. The fifth rate is
    without Phi. `p` has the document's symbols."""
    m1, m2, k1, k2, b1, b2 = (p[name] for name in ("m1", "m2", "k1", "k2", "b1", "b2"))
    aa, alpha, ctm, tau = (p[name] for name in ("A_a", "alpha", "C_tm", "tau"))
    b = b1 / m1 + b2 / m1 + b2 / m2
    a = [[0, 1, 0, 0, 0, 0],
         [-b1 * b2 / (m1 * m2), 0, b2 / m2 * b - k2 / m2, -b2 / m2, aa / m2, 0],
         [b1 / m1, 0, -b, 1, 0, 0],
         [k1 / m1, 0, -(k1 / m1 + k2 / m1 + k2 / m2), 0, aa / m1 + aa / m2, 0],
         [-aa * alpha * b1 / m1, 0, aa * alpha * b, -aa * alpha, -ctm * alpha, 0],
         [0, 0, 0, 0, 0, -1 / tau]]
    b = [[0, 0], [0, b1 * b2 / (m1 * m2)], [0, -b1 / m1], [0, -k1 / m1], [0, aa * alpha * b1 / m1],
         [p["k_sv"] / tau, 0]]
    return np.array(a, dtype=float), np.array(b)


# Konieczny eq. 3.2, in the document's units.
IDENTIFIED_A = np.array([
    [0, 1, 0, 0, 0, 0], [-231, -46, 23, 40, 2504, -401800], [0, 0, 0, 1, 0, 0],
    [305, 50, -1248, -77, -3493, 596600], [2, -1, -6, 1, -53, 10220], [0, 0, 0, 0, 0, -1]], dtype=float)
IDENTIFIED_B = np.array([[0, 0], [4442, 212], [0, 0], [-6879, 949], [47, 4], [0, 0]], dtype=float)


class ServoSuspensionIdentified(Smooth):
    states = ["body.position", "body.velocity", "wheel.position", "wheel.velocity", "pressure", "supply.power"]
    inputs = ["voltage", "road.position"]
    outputs = ["body.acceleration"]

    def __init__(self, parameters, _settings=None):
        p = parameters
        length, pressure, power = p["length_unit"], p["pressure_unit"], p["power_unit"]
        size = np.array([length, length, length, length, pressure, power])
        self.a = size[:, None] * IDENTIFIED_A / size
        self.b = size[:, None] * IDENTIFIED_B / np.array([1.0, length])

    def derivative(self, state, u, _mode):
        return (self.a @ state + self.b @ u).tolist()

    def output(self, state, u, mode):
        return [self.derivative(state, u, mode)[1]]
