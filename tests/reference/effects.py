"""The quarter car with the effects that a diagnosis looks for, in strut coordinates behind a linkage.

x = z_s - z_u and v = x'; i = 1 + i1 x, x_s = x + i1 x^2/2, v_s = i v; dz is a dead zone, <.> = max(., 0):

    F_strut  = i (F_spring + F_friction + F_damper + c v_s |v_s| + F_y tanh(v_s/v_y + beta x_s) + F_p
                  + s (curve over x_s + curve over v_s) + f + k1 xi)
    F_spring = k x_s + k2 x_s^2 + k3 x_s^3 + k_b (<x_s - x_r> - <-x_s - x_c>)
    F_friction = [F_c (1 + b x_s) + F_b exp(-(v_s/v_b)^2)] tanh(v_s/v0)
    F_damper = d(t) h(n(v_s)),  d(t) = d (1 - a (1 - exp(-t/T))),  n(v) = v + rho dz(v, v_k),
               h(v) = v + alpha (sqrt(v^2 + eps^2) - eps)
    guide    = F_g tanh(z_s'/v0) + d_g z_s' + curve,  wheel guide = F_w tanh(z_u'/v0) + d_w z_u'
    f   = dz(y, sigma b),  y' = sigma v_s G(1 - sgn(v_s) f/F),  G(u) = u ((u^2 + 1e-4)/(1 + 1e-4))^((n-1)/2)
    xi' = v_s - xi/tau
    with a mount F_damper = dz(e, g)/c,  e' = v_s - u,  d(t) h(n(u)) = F_damper

Every kink is a guard, so that the equations are smooth within a mode. The time is a state.
"""

import math

from corner import CONTACT, Tire
from integrate import Switched
from parameter_sets import G

POINTS, MIDDLE = 11, 5


class Curve:
    """Straight lines between equally spaced points, held beyond them. Its guards are its points.

    Two guards at one place would not be told apart: the numbers of a case keep points off other kinks.
    """

    def __init__(self, p, name, over):
        extent = p.get(f"{name}.{over}_range", 1.0)
        self.scale = p.get(f"{name}.scale", 0.0)
        self.y = [p.get(f"{name}.over_{over}[{i + 1}]", 0.0) for i in range(POINTS)]
        self.x = [extent * (2.0 * i / (POINTS - 1) - 1.0) for i in range(POINTS)] if self.scale else []

    def guards(self, at):
        return [at - x for x in self.x]

    def force(self, at, passed):
        if not self.x:
            return 0.0
        i = sum(passed)
        if i in (0, POINTS):
            return self.scale * self.y[min(i, POINTS - 1)]
        share = (at - self.x[i - 1]) / (self.x[i] - self.x[i - 1])
        return self.scale * (self.y[i - 1] * (1.0 - share) + self.y[i] * share)


class QuarterCarWithEffects(Switched):
    states = ["body.position", "body.velocity", "wheel.position", "wheel.velocity",
              "hysteresis.presliding.friction", "hysteresis.maxwell.deflection", "hysteresis.mount.deflection",
              "clock"]
    # The clock is no column: the states that are stand among the outputs.
    shown = False
    inputs = ["road.position", "road.velocity", "actuator.force"]
    outputs = states[:-1] + ["body.acceleration", "wheel.acceleration", "suspension.deflection",
                             "suspension.velocity", "tire.deflection", "wheel.force"]

    def __init__(self, parameters, settings):
        assert not settings["tire.lift_off"], "the tyre of these cases stays on the road"
        self.p = p = parameters
        self.tire = Tire(p, (p["sprung_mass"] + p["unsprung_mass"]) * G, False)
        self.curves = [Curve(p, "strut.curve", "deflection"), Curve(p, "strut.curve", "velocity"),
                       Curve(p, "guide.curve", "velocity"), Curve(p, "tire.curve", "deflection")]
        self.guard_count = len(self.guards([0.0] * 8, [0.0] * 3))

    def of(self, name, neutral=0.0):
        return self.p.get(name, neutral)

    def motion(self, state, u):
        """Ratio, deflection and velocity of the strut, compression of the tyre and its rate."""
        zs, vs, zu, vu = state[:4]
        x, slope = zs - zu, self.of("strut.linkage.slope")
        ratio = 1.0 + slope * x
        return ratio, x + 0.5 * slope * x * x, ratio * (vs - vu), u[0] - zu, u[1] - vu

    def play(self):
        """What the play takes of the presliding friction, in N."""
        return self.of("hysteresis.presliding.stiffness", 1e5) * self.of("hysteresis.presliding.gap")

    def damper_knee(self):
        return self.of("strut.knee.velocity", math.inf) if self.of("strut.knee.ratio") else math.inf

    def guards(self, state, u):
        _, x, v, c, _ = self.motion(state, u)
        knee, e, gap = self.damper_knee(), state[6], self.of("hysteresis.mount.gap")
        stop = self.of("strut.stop.stiffness") > 0.0
        kinks = [v]
        kinks += [v - knee, v + knee] if knee < math.inf else []
        kinks += [x - self.of("strut.stop.rebound_clearance"), -x - self.of("strut.stop.compression_clearance")] \
            if stop else []
        kinks += [e - gap, -e - gap] if gap > 0.0 else []
        play = self.play()
        kinks += [state[4] - play, -state[4] - play] if play > 0.0 else []
        for curve, at in zip(self.curves, (x, v, state[1], c)):
            # The middle point of the curve over the strut's velocity is at rest, which has a guard already.
            kinks += [kink for i, kink in enumerate(curve.guards(at)) if curve is not self.curves[1] or i != MIDDLE]
        return kinks

    def forces(self, state, u, mode):
        """Forces of strut, guide, wheel guide and tyre, and the rates of what the strut remembers."""
        side = iter(mode)
        ratio, x, v, c, rate = self.motion(state, u)
        _, body, _, wheel, f, xi, e, t = state
        of, p = self.of, self.p
        sign = 1.0 if next(side) else -1.0

        kneed = v
        if self.damper_knee() < math.inf:
            above, not_below = next(side), next(side)
            knee = self.damper_knee()
            kneed += of("strut.knee.ratio") * (v - knee if above else 0.0 if not_below else v + knee)
        spring = p["strut.stiffness"] * x + of("strut.spring.quadratic") * x**2 + of("strut.spring.cubic") * x**3
        if of("strut.stop.stiffness") > 0.0:
            rebound, compression = next(side), next(side)
            spring += of("strut.stop.stiffness") * (
                (x - of("strut.stop.rebound_clearance") if rebound else 0.0)
                - (-x - of("strut.stop.compression_clearance") if compression else 0.0))
        damping = p["strut.damping"] * (
            1.0 - of("strut.fade.ratio") * (1.0 - math.exp(-t / of("strut.fade.time", 100.0))))

        alpha, eps = p["strut.asymmetry.ratio"], p["strut.asymmetry.smoothing"]
        damper, bush_rate = damping * (kneed + alpha * (math.hypot(kneed, eps) - eps)), 0.0
        gap = of("hysteresis.mount.gap")
        if gap > 0.0 or of("hysteresis.mount.compliance") > 0.0:
            beyond = e
            if gap > 0.0:
                above, below = next(side), next(side)
                beyond = e - gap if above else e + gap if below else 0.0
            damper = beyond / of("hysteresis.mount.compliance", 1e-6)
            assert self.damper_knee() == math.inf, "behind a mount the damper has no knee here"
            bush_rate = v - velocity_of(damper / damping, alpha, eps)

        if self.play() > 0.0:
            above, below = next(side), next(side)
            f = f - self.play() if above else f + self.play() if below else 0.0

        remembered = [0.0, 0.0, bush_rate]
        if of("hysteresis.presliding.force") > 0.0:
            n = of("hysteresis.presliding.exponent", 1.0)
            left = 1.0 - sign * f / of("hysteresis.presliding.force")
            remembered[0] = (of("hysteresis.presliding.stiffness", 1e5) * v * left
                             * ((left * left + 1e-4) / (1.0 + 1e-4)) ** (0.5 * (n - 1.0)))
        if of("hysteresis.maxwell.stiffness") > 0.0:
            remembered[1] = v - xi / of("hysteresis.maxwell.time", 0.01)

        pieces = []
        for curve, at in zip(self.curves, (x, v, body, c)):
            passed = [sign > 0.0 if curve is self.curves[1] and i == MIDDLE else next(side)
                      for i in range(len(curve.x))]
            pieces.append(curve.force(at, passed))
        dry = p["strut.coulomb.force"] * (1.0 + of("strut.load_dependence.slope") * x)
        dry += of("strut.stribeck.force") * math.exp(-((v / of("strut.stribeck.velocity", 0.01)) ** 2))
        strut = ratio * (
            spring + damper + dry * math.tanh(v / p["strut.coulomb.velocity"])
            + of("strut.orifice.coefficient") * sign * v * v
            + of("strut.yield.force") * math.tanh(v / of("strut.yield.velocity", 0.02) + of("strut.yield.slope") * x)
            + of("strut.preload") + pieces[0] + pieces[1]
            + (f if of("hysteresis.presliding.force") > 0.0 else 0.0) + of("hysteresis.maxwell.stiffness") * xi)
        guide = (p["guide.coulomb.force"] * math.tanh(body / p["guide.coulomb.velocity"])
                 + of("guide.damping") * body + pieces[2])
        wheel_guide = (of("wheel_guide.damping") * wheel + of("wheel_guide.coulomb.force")
                       * math.tanh(wheel / of("wheel_guide.coulomb.velocity", 0.008)))
        return strut, guide, wheel_guide, self.tire.force(c, rate, CONTACT) + pieces[3], remembered

    def derivative(self, state, u, mode):
        strut, guide, wheel_guide, tire, remembered = self.forces(state, u, mode)
        return [state[1], (u[2] - strut - guide) / self.p["sprung_mass"],
                state[3], (strut - u[2] + tire - wheel_guide) / self.p["unsprung_mass"], *remembered, 1.0]

    def output(self, state, u, mode):
        zs, vs, zu, vu = state[:4]
        rates = self.derivative(state, u, mode)
        return [*state[:-1], rates[1], rates[3], zs - zu, vs - vu, zu - u[0], self.forces(state, u, mode)[3]]


def velocity_of(effective, alpha, eps):
    """The u with u + alpha (sqrt(u^2 + eps^2) - eps) = effective, by Newton's method."""
    u = effective
    for _ in range(60):
        root = math.hypot(u, eps)
        step = (u + alpha * (root - eps) - effective) / (1.0 + alpha * u / root)
        u -= step
        if abs(step) <= 1e-17 + 1e-16 * abs(u):
            break
    return u
