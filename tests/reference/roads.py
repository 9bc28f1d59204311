"""Road excitations: position and its exact time derivative, tau = t - start, zero for tau < 0.

    sine            A sin(2 pi f tau)
    square          edges at tau = k / (2 f): to +A for even k, to -A for odd k, from 0 at k = 0
    step            one edge, from 0 to A, at tau = 0
      an edge from p to q that begins at tau_e, of duration T_e:
                    p + (q - p) (1 - cos(pi (tau - tau_e) / T_e)) / 2
    chirp           A sin(phi), phi = 2 pi (f0 tau + (f1 - f0) tau^2 / (2 T)) up to tau = T,
                    afterwards phi(T) + 2 pi f1 (tau - T)
    frequency_ramp  A sin(pi r tau^2), the frequency being r tau
    bump            h (1 - cos(2 pi s / L)) / 2 for 0 <= s <= L, s = speed tau
    iso8608         z(s) - z(0), z(s) = sum a_i sin(2 pi n_i s + phi_i), s = speed tau
                    a_i = sqrt(2 Gd(n_i) dn_i), Gd(n) = Gd(n0) (n / n0)^-2, n0 = 0.1 cycles/m
                    256 bands, logarithmic from 0.011 to 2.83 cycles/m, n_i the geometric mean
                    of a band's ends, dn_i their difference
                    Gd(n0) = 16e-6 m^3 for class A, four times as much per class, to H
                    phi_i = 2 pi (next >> 11) / 2^53 from SplitMix64, state = seed, lowest band first

The velocity of iso8608 jumps at the start: the profile has a slope there.
"""

import math

import numpy as np

MASK = (1 << 64) - 1


def splitmix64(seed):
    """SplitMix64 (Steele, Lea, Flood 2014)."""
    state = seed & MASK
    while True:
        state = (state + 0x9E3779B97F4A7C15) & MASK
        z = state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        yield z ^ (z >> 31)


class IsoProfile:
    bands, lowest, highest, reference = 256, 0.011, 2.83, 0.1

    def __init__(self, road_class, seed):
        self.roughness = 16e-6 * 4.0 ** "ABCDEFGH".index(road_class)
        ratio = self.highest / self.lowest
        ends = [self.lowest * ratio ** (i / self.bands) for i in range(self.bands + 1)]
        self.ends = np.array(ends)
        self.centres = np.sqrt(self.ends[:-1] * self.ends[1:])
        self.widths = np.diff(self.ends)
        density = self.roughness * (self.centres / self.reference) ** -2
        self.amplitudes = np.sqrt(2.0 * density * self.widths)
        source = splitmix64(seed)
        self.phases = np.array([2.0 * math.pi * ((next(source) >> 11) / 2.0**53)
                                for _ in range(self.bands)])
        self.wave_numbers = 2.0 * math.pi * self.centres
        self.origin = float(self.amplitudes @ np.sin(self.phases))

    def __call__(self, s):
        """Height above the starting point, and slope."""
        angle = self.wave_numbers * s + self.phases
        height = float(self.amplitudes @ np.sin(angle)) - self.origin
        return height, float((self.amplitudes * self.wave_numbers) @ np.cos(angle))


class Road:
    """Called as road(t, branch): `branch` is the time that selects the piece of the formula,
    so that a piece can be evaluated up to and including its ends."""

    def __init__(self, kind, **p):
        self.kind, self.p, self.start = kind, p, p.get("start", 0.0)
        self.profile = IsoProfile(p["road_class"], p["seed"]) if kind == "iso8608" else None

    def __call__(self, t, branch=None):
        tau = t - self.start
        select = (t if branch is None else branch) - self.start
        if select < 0.0:
            return 0.0, 0.0
        return getattr(self, self.kind)(tau, select, self.p)

    def sine(self, tau, _select, p):
        w = 2.0 * math.pi * p["frequency"]
        return p["amplitude"] * math.sin(w * tau), p["amplitude"] * w * math.cos(w * tau)

    def square(self, tau, select, p):
        half = 0.5 / p["frequency"]
        k = math.floor(select / half)
        target = p["amplitude"] if k % 2 == 0 else -p["amplitude"]
        origin = 0.0 if k == 0 else -target
        return edge(tau - k * half, select - k * half, origin, target, p["edge_time"])

    def step(self, tau, select, p):
        return edge(tau, select, 0.0, p["amplitude"], p["edge_time"])

    def chirp(self, tau, select, p):
        f0, f1, duration = p["start_frequency"], p["end_frequency"], p["duration"]
        if select <= duration:
            phase = 2.0 * math.pi * (f0 * tau + (f1 - f0) * tau * tau / (2.0 * duration))
            frequency = f0 + (f1 - f0) * tau / duration
        else:
            phase = 2.0 * math.pi * (0.5 * (f0 + f1) * duration + f1 * (tau - duration))
            frequency = f1
        a = p["amplitude"]
        return a * math.sin(phase), a * 2.0 * math.pi * frequency * math.cos(phase)

    def frequency_ramp(self, tau, _select, p):
        a, rate = p["amplitude"], p["rate"]
        phase = math.pi * rate * tau * tau
        return a * math.sin(phase), a * 2.0 * math.pi * rate * tau * math.cos(phase)

    def bump(self, tau, select, p):
        if select > p["length"] / p["speed"]:
            return 0.0, 0.0
        w = 2.0 * math.pi * p["speed"] / p["length"]
        return (0.5 * p["height"] * (1.0 - math.cos(w * tau)),
                0.5 * p["height"] * w * math.sin(w * tau))

    def iso8608(self, tau, _select, p):
        height, slope = self.profile(p["speed"] * tau)
        return height, slope * p["speed"]

    def breaks(self, stop):
        """Times where the formula changes its piece."""
        marks = [0.0]
        if self.kind in ("square", "step"):
            half = 0.5 / self.p["frequency"] if self.kind == "square" else math.inf
            begin = 0.0
            k = 0
            while begin <= stop:
                marks += [begin, begin + self.p["edge_time"]]
                k += 1
                begin = k * half
        if self.kind == "chirp":
            marks.append(self.p["duration"])
        if self.kind == "bump":
            marks.append(self.p["length"] / self.p["speed"])
        return sorted({self.start + mark for mark in marks})


def edge(tau, select, origin, target, duration):
    if select >= duration:
        return target, 0.0
    w = math.pi / duration
    return (origin + (target - origin) * 0.5 * (1.0 - math.cos(w * tau)),
            (target - origin) * 0.5 * w * math.sin(w * tau))
