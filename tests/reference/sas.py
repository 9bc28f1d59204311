"""The semi-active rig, Kogut 3, with what eq. 13 and 16 get wrong put right (README).

    I_1 a_1'' = lever F_t - h_1 k_s l_s - M_1 cos(beta - a_1) + T
    I_2 g''   = h_2 k_s l_s - M_2 cos g - T,  T = brake torque + T_p tanh((g' - a_1') / w_p)
    l_s = l_s0 - sqrt(r_1^2 + r_2^2 - 2 r_1 r_2 cos(g - a_1))
    l_t = l_t0 - (H - r - u_1 - R sin(beta - a_1)),  lever = R cos(beta - a_1) = -dl_t / da_1
    h_1 = r_1, h_2 = r_2 (Printed); h_1 = h_2 = r_2 (Perpendicular); h_1 = h_2 = dl_s / dg (Exact)

The tyre is that of `corner` without static load; with lift-off it does not pull. A locked wheel arm does not move
(eq. 1).

The brake: field' = (duty - field) / tau, duty held in [0, 1] in steps of 1 / (2^bits - 1), nine tenths of a change
within the response time; T = k(field) speed, k linear between 21 points.
"""

import math

from scipy.optimize import fsolve

from corner import Tire
from integrate import Smooth
from table import Table, array


class SasRig(Smooth):
    states = ["wheel_arm.angle", "wheel_arm.speed", "body_arm.angle", "body_arm.speed"]
    inputs = ["brake.torque", "eccentric.height", "eccentric.velocity"]
    outputs = ["wheel_arm.acceleration", "body_arm.acceleration", "relative.angle", "relative.speed",
               "spring.compression", "spring.force", "tire.compression", "tire.force"]
    guard_count = Tire.guard_count

    def __init__(self, parameters, settings):
        p = parameters
        self.locked, self.lever = settings.get("wheel_arm.locked", False), settings.get("spring.lever", "Printed")
        self.i1, self.m1 = p["wheel_arm.inertia"], p["wheel_arm.gravity_moment"]
        self.i2, self.m2 = p["body_arm.inertia"], p["body_arm.gravity_moment"]
        self.r, self.beta = p["wheel_arm.length"], p["wheel_arm.offset"]
        self.ks, self.ls0 = p["spring.stiffness"], p["spring.free_length"]
        self.r1, self.r2 = p["spring.wheel_arm_mount"], p["spring.body_arm_mount"]
        self.friction, self.friction_speed = p["pivot.coulomb.torque"], p["pivot.coulomb.speed"]
        self.gap = p["eccentric.depth"] - p["wheel.rim_radius"] - p["wheel.tire_thickness"]
        self.tire = Tire(p, 0.0, settings.get("tire.lift_off", False))

    def spring(self, angle):
        """Compression and the levers on wheel arm and body arm."""
        length = math.sqrt(self.r1**2 + self.r2**2 - 2.0 * self.r1 * self.r2 * math.cos(angle))
        exact = self.r1 * self.r2 * math.sin(angle) / length
        levers = {"Printed": (self.r1, self.r2), "Perpendicular": (self.r2, self.r2), "Exact": (exact, exact)}
        return self.ls0 - length, levers[self.lever]

    def contact(self, state, u):
        """Lever, compression and its rate."""
        lever = self.r * math.cos(self.beta - state[0])
        compression = u[1] + self.r * math.sin(self.beta - state[0]) - self.gap
        return lever, compression, u[2] - lever * self.speed(state)

    def speed(self, state):
        return 0.0 if self.locked else state[1]

    def moments(self, state, u, mode):
        a, g = state[0], state[2]
        compression, (on_wheel, on_body) = self.spring(g - a)
        lever, squeeze, rate = self.contact(state, u)
        torque = u[0] + self.friction * math.tanh((state[3] - self.speed(state)) / self.friction_speed)
        spring = self.ks * compression
        force = self.tire.force(squeeze, rate, mode)
        return (lever * force - on_wheel * spring - self.m1 * math.cos(self.beta - a) + torque,
                on_body * spring - self.m2 * math.cos(g) - torque)

    def derivative(self, state, u, mode):
        wheel, body = self.moments(state, u, mode)
        return [self.speed(state), 0.0 if self.locked else wheel / self.i1, state[3], body / self.i2]

    def output(self, state, u, mode):
        _, wheel, _, body = self.derivative(state, u, mode)
        compression, _ = self.spring(state[2] - state[0])
        _, squeeze, rate = self.contact(state, u)
        return [wheel, body, state[2] - state[0], state[3] - self.speed(state), compression, self.ks * compression,
                squeeze, self.tire.force(squeeze, rate, mode)]

    def mode(self, state, u):
        return self.tire.mode(*self.contact(state, u)[1:])

    def guards(self, state, u):
        return self.tire.guards(*self.contact(state, u)[1:])

    def watched(self, mode):
        return self.tire.watched(mode)

    def after(self, mode, guard, state, u):
        return self.tire.after(mode, guard, self.contact(state, u)[2])

    def rest(self, height=0.04, guess=(-0.2, 0.35)):
        """Angles of static equilibrium, the wheel arm at zero if it is locked."""
        def moments(angles):
            wheel, body = (0.0, angles[-1]) if self.locked else angles
            found = self.moments([wheel, 0.0, body, 0.0], [0.0, height, 0.0], "contact")
            return found[1:] if self.locked else found
        found = fsolve(moments, guess[1:] if self.locked else guess, xtol=1e-12)
        return [0.0, *found.tolist()] if self.locked else found.tolist()

    def load(self, height=0.04):
        """Force of the tyre at rest."""
        wheel, body = self.rest(height)
        return self.output([wheel, 0.0, body, 0.0], [0.0, height, 0.0], "contact")[-1]


class MrRotaryBrake(Smooth):
    states = ["field"]
    inputs = ["duty", "relative.speed"]
    outputs = ["torque", "damping"]
    points = 21

    def __init__(self, parameters, settings):
        self.steps = 2 ** settings.get("pwm.bits", 0) - 1
        self.tau = parameters["response_time"] / math.log(10.0)
        self.profile = Table([k / (self.points - 1) for k in range(self.points)],
                             array(parameters, "profile", self.points), held=True)

    def duty(self, wanted):
        wanted = min(1.0, max(0.0, wanted))
        return round(wanted * self.steps) / self.steps if self.steps else wanted

    def derivative(self, state, u, _mode):
        return [(self.duty(u[0]) - state[0]) / self.tau]

    def output(self, state, u, _mode):
        # The field does not depend on the profile, so that its kinks need no mode.
        damping = self.profile.value(state[0], self.profile.piece(state[0]))
        return [damping * u[1], damping]
