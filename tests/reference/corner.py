"""Strut and tyre, TUM 4.3: what a corner of a car is made of.

Deflection x = z_s - z_u and v = x', compression c = z_r - z_u:

    F_strut = k x + d (v + alpha (sqrt(v^2 + eps^2) - eps)) + F_c tanh(v / v0)
    F_tire  = k_t c + q c^2 + d_t c' + F_t tanh(c' / v0)

With lift-off, F0 the static load and c_l the root of F0 + k_t c + q c^2 = 0 nearest zero:
F_tire = -F0 for c <= c_l, else the larger of -F0 and the expression above. The tyre is a hybrid element: guards mark
where its law is not smooth, a mode says on which side of each guard it is.
"""

import math

CONTACT, CLIPPED, AIRBORNE = "contact", "clipped", "airborne"


class Strut:
    def __init__(self, parameters, prefix="strut."):
        def p(name):
            return parameters[prefix + name]
        self.k, self.d = p("stiffness"), p("damping")
        self.alpha, self.eps = p("asymmetry.ratio"), p("asymmetry.smoothing")
        self.fc, self.vc = p("coulomb.force"), p("coulomb.velocity")

    def force(self, x, v):
        rounded = math.sqrt(v * v + self.eps * self.eps) - self.eps
        return self.k * x + self.d * (v + self.alpha * rounded) + self.fc * math.tanh(v / self.vc)


class Tire:
    guard_count = 2

    def __init__(self, parameters, static_load, lift_off, prefix="tire."):
        def p(name):
            return parameters[prefix + name]
        self.kt, self.q, self.dt = p("stiffness"), p("quadratic"), p("damping")
        self.ft, self.vt = p("coulomb.force"), p("coulomb.velocity")
        self.static_load, self.lift_off = static_load, lift_off
        self.lift_off_compression = lift_off_compression(static_load, self.kt, self.q)

    def loss(self, rate):
        return self.dt * rate + self.ft * math.tanh(rate / self.vt)

    def force(self, c, rate, mode):
        if mode == CONTACT:
            return self.kt * c + self.q * c * c + self.loss(rate)
        return -self.static_load

    def mode(self, c, rate):
        if not self.lift_off:
            return CONTACT
        above, unclipped = self.guards(c, rate)
        if above <= 0.0:
            return AIRBORNE
        return CONTACT if unclipped >= 0.0 else CLIPPED

    def guards(self, c, rate):
        """Compression above the lift-off point; tyre force above minus the static load."""
        return (c - self.lift_off_compression,
                self.kt * c + self.q * c * c + self.loss(rate) + self.static_load)

    def watched(self, mode):
        """The guards that can end a mode, as (index, direction of crossing)."""
        if not self.lift_off:
            return []
        return {CONTACT: [(0, -1), (1, -1)], CLIPPED: [(0, -1), (1, 1)], AIRBORNE: [(0, 1)]}[mode]

    def after(self, mode, guard, rate):
        if guard == 1:
            return CLIPPED if mode == CONTACT else CONTACT
        if mode != AIRBORNE:
            return AIRBORNE
        # At c_l the spring force is -F0, so the loss alone decides.
        return CONTACT if self.loss(rate) >= 0.0 else CLIPPED


def lift_off_compression(load, stiffness, quadratic):
    """The root nearest zero of load + stiffness c + quadratic c^2 = 0."""
    if quadratic == 0.0:
        return -load / stiffness
    # Written without cancellation.
    return -2.0 * load / (stiffness + math.sqrt(stiffness**2 - 4.0 * quadratic * load))
