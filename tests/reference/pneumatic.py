"""A mass on a guide, driven by an air cylinder behind a proportional valve.

    m x'' = A_A p_A - A_B p_B - A_r p_amb - g(x') - ends(x) - F_0 + load
    V_A p_A' = p_0 (e(Q_A) + e(-Q_L) + Q_0A) - n p_A A_A x',  V_A = V_0A + A_A (L/2 + x)
    V_B p_B' = p_0 (e(Q_B) + e(Q_L) + Q_0B) + n p_B A_B x',  V_B = V_0B + A_B (L/2 - x)
    e(Q) = n_in Q for Q > 0, n_out Q for Q < 0
    Q_A = C |u| f(p_1, p_A),  Q_B = C |u| f(p_2, p_B),  Q_L = G (p_A - p_B)
    p_1, p_2 = supply, exhaust for u > 0, and exhaust, supply for u < 0
    T y' = clamp(k v, -1, 1) - y,  u = y beyond the overlap on either side
    f: ISO 6358-1 with critical ratio b, straight beyond the laminar ratio l:
       p_1                                         p_2 < b p_1
       p_1 sqrt(1 - ((p_2/p_1 - b)/(1 - b))^2)     between
       (p_1 - p_2) sqrt(1 - ((l - b)/(1 - b))^2)/(1 - l)      p_2 > l p_1 and p_1 > l p_2
"""

import math

from integrate import Switched

REFERENCE, AMBIENT = 1e5, 101325.0


class PneumaticCylinder(Switched):
    states = ["carriage.position", "carriage.velocity", "chamber_a.pressure", "chamber_b.pressure", "spool.position"]
    inputs = ["voltage", "load.force"]
    outputs = ["acceleration", "position", "velocity", "actuator.force", "supply.flow"]
    # Three of the opening, two of the ends, ten of each chamber's edges, one of the leakage.
    guard_count = 26
    # Pressures pass the laminar range in tenths of a millisecond.
    max_step = 1e-4

    def __init__(self, parameters, _settings):
        self.p = parameters
        a = self.of
        self.areas = [a("cylinder.area"), a("cylinder.area") - a("cylinder.rod_area")]
        self.lines = [a("supply.pressure"), a("supply.exhaust_pressure")]

    def of(self, name):
        return self.p["actuator." + name]

    def edges(self, pressure):
        """For both lines: not choked inwards, not choked outwards, straight or outwards, straight or inwards, inwards."""
        b, laminar = self.of("valve.critical_ratio"), self.of("valve.laminar_ratio")
        # With one exponent for both ways there is no kink, and a flow that fades away has no side.
        alike = self.exponent(True) == self.exponent(False)
        return [guard for line in self.lines for guard in (
            pressure - b * line, line - b * pressure, pressure - laminar * line, line - laminar * pressure,
            1.0 if alike else line - pressure)]

    def guards(self, state, _u):
        x, _, p_a, p_b, y = state
        overlap, half = self.of("spool.overlap"), 0.5 * self.of("cylinder.stroke")
        return [y, y - overlap, -overlap - y, x - half, -half - x, *self.edges(p_a), *self.edges(p_b), p_a - p_b]

    def through(self, line, pressure, sides):
        b, laminar = self.of("valve.critical_ratio"), self.of("valve.laminar_ratio")
        slow_in, slow_out, not_in, not_out, _ = sides
        # A solver tries a step that goes beyond the end of a piece.
        ellipse = lambda ratio: math.sqrt(max(0.0, 1.0 - ((ratio - b) / (1.0 - b)) ** 2))
        if not_in and not_out:
            return (line - pressure) * ellipse(laminar) / (1.0 - laminar)
        if not_in:
            return -pressure * (ellipse(line / pressure) if slow_out else 1.0)
        return line * (ellipse(pressure / line) if slow_in else 1.0)

    def flows(self, state, mode):
        """Through the valve into the chambers, the same with their exponents, and out of the supply."""
        _, _, p_a, p_b, y = state
        overlap = self.of("spool.overlap")
        opening = y - overlap if mode[1] else y + overlap if mode[2] else 0.0
        # A positive opening joins A to the supply, line 0, and B to the exhaust, line 1.
        line_a = 0 if mode[0] else 1
        conductance = self.of("valve.conductance") * abs(opening)
        sides = [mode[5 + 5 * line_a:10 + 5 * line_a], mode[15 + 5 * (1 - line_a):20 + 5 * (1 - line_a)]]
        through = [conductance * self.through(self.lines[line], pressure, side)
                   for line, pressure, side in zip((line_a, 1 - line_a), (p_a, p_b), sides)]
        carried = [self.exponent(side[-1]) * flow for flow, side in zip(through, sides)]
        return carried, through[line_a]

    def exponent(self, inwards):
        return self.of(f"air.{'filling' if inwards else 'emptying'}_exponent")

    def forces(self, state, u, mode):
        """Acceleration, and the air's force."""
        x, v, p_a, p_b, _ = state
        get = lambda name, otherwise=0.0: self.p.get("guide." + name, otherwise)
        friction = get("coulomb.force") + get("stribeck.force") * math.exp(-(v / get("stribeck.velocity", 0.01)) ** 2)
        resistance = get("damping") * v + friction * math.tanh(v / get("coulomb.velocity", 0.008))
        air = self.areas[0] * p_a - self.areas[1] * p_b - self.of("cylinder.rod_area") * AMBIENT
        half = 0.5 * self.of("cylinder.stroke")
        beyond = x - half if mode[3] else x + half if mode[4] else 0.0
        others = resistance + self.of("cylinder.end_stiffness") * beyond + self.p.get("constant_load", 0.0) - u[1]
        return (air - others) / self.p["moving_mass"], air

    def derivative(self, state, u, mode):
        x, v, p_a, p_b, y = state
        carried, _ = self.flows(state, mode)
        leak = self.of("cylinder.leakage") * (p_a - p_b)
        half = 0.5 * self.of("cylinder.stroke")
        rates = []
        for chamber, side, pressure, area, flow in zip("ab", (1.0, -1.0), (p_a, p_b), self.areas, carried):
            flow -= side * leak * self.exponent(mode[25] != (chamber == "a"))
            flow += self.of(f"cylinder.chamber_{chamber}.flow_offset")
            way = half + side * x
            inside = not mode[4 if chamber == "a" else 3]
            volume = self.of(f"cylinder.chamber_{chamber}.dead_volume") + area * (way if inside else 0.0)
            pressed = self.of("air.compression_exponent") * pressure * area * side * v if inside else 0.0
            rates.append((REFERENCE * flow - pressed) / volume)
        aim = min(1.0, max(-1.0, self.of("spool.gain") * u[0]))
        return [v, self.forces(state, u, mode)[0], *rates, (aim - y) / self.of("spool.time_constant")]

    def output(self, state, u, mode):
        acceleration, air = self.forces(state, u, mode)
        return [acceleration, state[0], state[1], air, self.flows(state, mode)[1]]
