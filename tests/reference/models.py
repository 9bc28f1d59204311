"""The rig and the linear motor, written from the sources.

Both are hybrid: guards mark where the right-hand side is not smooth, a mode says on which
side of each guard the state is. `derivative` depends on the mode, never on a guard's sign.

QuarterCar, TUM 4.3-4.4, deflection x = z_s - z_u and v = x', compression c = z_r - z_u:

    m_s z_s'' = -F_strut + F_act - F_guide
    m_u z_u'' =  F_strut - F_act + F_tire
    F_strut = k x + d (v + alpha (sqrt(v^2 + eps^2) - eps)) + F_c tanh(v / v0)
    F_guide = F_g tanh(z_s' / v0)
    F_tire  = k_t c + q c^2 + d_t c' + F_t tanh(c' / v0)

With lift-off, F0 = (m_s + m_u) g and c_l the root of F0 + k_t c + q c^2 = 0 nearest zero:
F_tire = -F0 for c <= c_l, else the larger of -F0 and the expression above.

LinearMotor, TUM eq. 10-11 and eq. 1:

    v1' = -320.4019 v1 + 1.2131 u,  v2' = 250 (v1 - v2),  i = 839.4076 v2,  F = 100 i
    q'  = i^2 - i_c^2, not below zero,  Q = (i_p^2 - i_c^2) 1 s
    |i| limit = i_c + (i_p - i_c) clamp((Q - q) / (0.02 Q), 0, 1)
"""

import math

from parameter_sets import G, MOTOR

CONTACT, CLIPPED, AIRBORNE = "contact", "clipped", "airborne"
FREE, HELD = "free", "held"


class QuarterCar:
    states = ["body.position", "body.velocity", "wheel.position", "wheel.velocity"]
    inputs = ["road.position", "road.velocity", "actuator.force"]
    outputs = ["body.acceleration", "wheel.acceleration", "suspension.deflection",
               "suspension.velocity", "tire.deflection", "wheel.force"]

    def __init__(self, parameters, lift_off=False):
        p = parameters
        self.ms, self.mu = p["sprung_mass"], p["unsprung_mass"]
        self.k, self.d = p["strut.stiffness"], p["strut.damping"]
        self.alpha, self.eps = p["strut.asymmetry.ratio"], p["strut.asymmetry.smoothing"]
        self.fc, self.vc = p["strut.coulomb.force"], p["strut.coulomb.velocity"]
        self.fg, self.vg = p["guide.coulomb.force"], p["guide.coulomb.velocity"]
        self.kt, self.q, self.dt = p["tire.stiffness"], p["tire.quadratic"], p["tire.damping"]
        self.ft, self.vt = p["tire.coulomb.force"], p["tire.coulomb.velocity"]
        self.lift_off = lift_off
        self.static_load = (self.ms + self.mu) * G
        self.lift_off_compression = lift_off_compression(self.static_load, self.kt, self.q)

    def strut_force(self, x, v):
        rounded = math.sqrt(v * v + self.eps * self.eps) - self.eps
        return self.k * x + self.d * (v + self.alpha * rounded) + self.fc * math.tanh(v / self.vc)

    def tire_loss(self, rate):
        return self.dt * rate + self.ft * math.tanh(rate / self.vt)

    def tire_force(self, c, rate, mode):
        if mode == CONTACT:
            return self.kt * c + self.q * c * c + self.tire_loss(rate)
        return -self.static_load

    def derivative(self, state, u, mode):
        zs, vs, zu, vu = state
        road, road_rate, force = u
        strut = self.strut_force(zs - zu, vs - vu)
        guide = self.fg * math.tanh(vs / self.vg)
        tire = self.tire_force(road - zu, road_rate - vu, mode)
        return [vs, (-strut + force - guide) / self.ms, vu, (strut - force + tire) / self.mu]

    def output(self, state, u, mode):
        zs, vs, zu, vu = state
        road, road_rate, _ = u
        _, body, _, wheel = self.derivative(state, u, mode)
        tire = self.tire_force(road - zu, road_rate - vu, mode)
        return [body, wheel, zs - zu, vs - vu, zu - road, tire]

    def mode(self, state, u):
        if not self.lift_off:
            return CONTACT
        above, unclipped = self.guards(state, u)
        if above <= 0.0:
            return AIRBORNE
        return CONTACT if unclipped >= 0.0 else CLIPPED

    def guards(self, state, u):
        """Compression above the lift-off point; tyre force above minus the static load."""
        c, rate = u[0] - state[2], u[1] - state[3]
        return (c - self.lift_off_compression,
                self.kt * c + self.q * c * c + self.tire_loss(rate) + self.static_load)

    def watched(self, mode):
        """The guards that can end a mode, as (index, direction of crossing)."""
        if not self.lift_off:
            return []
        return {CONTACT: [(0, -1), (1, -1)], CLIPPED: [(0, -1), (1, 1)], AIRBORNE: [(0, 1)]}[mode]

    def after(self, mode, guard, state, u):
        if guard == 1:
            return CLIPPED if mode == CONTACT else CONTACT
        if mode != AIRBORNE:
            return AIRBORNE
        # At c_l the spring force is -F0, so the loss alone decides.
        return CONTACT if self.tire_loss(u[1] - state[3]) >= 0.0 else CLIPPED

    def settle(self, state, _mode):
        return state

    def energy(self, state, road=0.0):
        """Kinetic energy and the energy of both springs."""
        zs, vs, zu, vu = state
        c = road - zu
        return (0.5 * self.ms * vs**2 + 0.5 * self.mu * vu**2 + 0.5 * self.k * (zs - zu)**2
                + 0.5 * self.kt * c**2 + self.q * c**3 / 3.0)


def lift_off_compression(load, stiffness, quadratic):
    """The root nearest zero of load + stiffness c + quadratic c^2 = 0."""
    if quadratic == 0.0:
        return -load / stiffness
    # Written without cancellation.
    return -2.0 * load / (stiffness + math.sqrt(stiffness**2 - 4.0 * quadratic * load))


class LinearMotor:
    states = ["v1", "v2", "q"]
    inputs = ["voltage", "force_reference"]
    outputs = ["current", "force"]

    def __init__(self, parameters=MOTOR):
        p = parameters
        self.pole, self.gain = p["electric_pole"], p["input_gain"]
        self.delay, self.readout = p["delay_pole"], p["current_gain"]
        self.force_constant, self.voltage_limit = p["force_constant"], p["voltage_limit"]
        self.peak, self.continuous = p["peak_current"], p["continuous_current"]
        self.capacity = (self.peak**2 - self.continuous**2) * p["peak_time"]
        self.fade = p["fade"]
        self.static_gain = self.gain * self.readout / self.pole

    def current_limit(self, q):
        share = (self.capacity - q) / (self.fade * self.capacity)
        return self.continuous + (self.peak - self.continuous) * min(1.0, max(0.0, share))

    def command(self, q, u):
        wanted = u[0] + u[1] / (self.static_gain * self.force_constant)
        bound = min(self.voltage_limit, self.current_limit(q) / self.static_gain)
        return min(bound, max(-bound, wanted))

    def derivative(self, state, u, mode):
        v1, v2, q = state
        surplus = (self.readout * v2)**2 - self.continuous**2
        return [-self.pole * v1 + self.gain * self.command(q, u), self.delay * (v1 - v2),
                surplus if mode == FREE else 0.0]

    def output(self, state, _u, _mode):
        current = self.readout * state[1]
        return [current, self.force_constant * current]

    def mode(self, state, u):
        empty, surplus = self.guards(state, u)
        return HELD if empty <= 0.0 and surplus <= 0.0 else FREE

    def guards(self, state, _u):
        """The accumulator's content; the square of the current above the continuous one."""
        return state[2], (self.readout * state[1])**2 - self.continuous**2

    def watched(self, mode):
        return [(0, -1)] if mode == FREE else [(1, 1)]

    def after(self, mode, _guard, _state, _u):
        return HELD if mode == FREE else FREE

    def settle(self, state, mode):
        """In the held mode the accumulator is empty, exactly."""
        return [state[0], state[1], 0.0] if mode == HELD else state
