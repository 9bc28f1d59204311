"""Road excitations: position and its exact time derivative, tau = t - start_time, zero for tau < 0.

    Sine            A sin(2 pi f tau)
    Square          edges at tau = k / (2 f): to +A for even k, to -A for odd k, from 0 at k = 0
    Step            one edge, from 0 to the step's height, at tau = 0
      an edge from p to q that begins at tau_e, of duration T_e:
                    p + (q - p) (1 - cos(pi (tau - tau_e) / T_e)) / 2
    Chirp           A sin(phi), phi = 2 pi (f0 tau + (f1 - f0) tau^2 / (2 T)) up to tau = T,
                    afterwards phi(T) + 2 pi f1 (tau - T)
    FrequencyRamp   A sin(pi r tau^2), the frequency being r tau
    Bump            h (1 - cos(2 pi s / L)) / 2 for 0 <= s <= L, s = speed tau
    Iso8608         z(s) - z(0), z(s) = sum a_i sin(2 pi n_i s + phi_i), s = speed tau
                    a_i = sqrt(2 Gd(n_i) dn_i), Gd(n) = Gd(n0) (n / n0)^-2, n0 = 0.1 cycles/m
                    256 bands, logarithmic from 0.011 to 2.83 cycles/m, n_i the geometric mean
                    of a band's ends, dn_i their difference
                    Gd(n0) = 16e-6 m^3 for class A, four times as much per class, to H
                    phi_i = 2 pi (next >> 11) / 2^53 from SplitMix64, state = seed, lowest band first;
                    a second track goes on with the next random numbers

The velocity of Iso8608 jumps at the start: the profile has a slope there.
Under four wheels the rear ones follow the front ones after wheelbase / speed, left and right ones on two tracks.
"""

import math
from itertools import islice

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

    def __init__(self, road_class, seed, track=0):
        self.roughness = 16e-6 * 4.0 ** "ABCDEFGH".index(road_class)
        ratio = self.highest / self.lowest
        ends = [self.lowest * ratio ** (i / self.bands) for i in range(self.bands + 1)]
        self.ends = np.array(ends)
        self.centres = np.sqrt(self.ends[:-1] * self.ends[1:])
        self.widths = np.diff(self.ends)
        density = self.roughness * (self.centres / self.reference) ** -2
        self.amplitudes = np.sqrt(2.0 * density * self.widths)
        numbers = islice(splitmix64(seed), track * self.bands, (track + 1) * self.bands)
        self.phases = np.array([2.0 * math.pi * ((number >> 11) / 2.0**53) for number in numbers])
        self.wave_numbers = 2.0 * math.pi * self.centres
        self.origin = float(self.amplitudes @ np.sin(self.phases))

    def __call__(self, s):
        """Height above the starting point, and slope."""
        angle = self.wave_numbers * s + self.phases
        height = float(self.amplitudes @ np.sin(angle)) - self.origin
        return height, float((self.amplitudes * self.wave_numbers) @ np.cos(angle))

    def near(self, middle, reach):
        """The same within `reach` of `middle`, from the profile's derivatives there: for many points close by."""
        angle = self.wave_numbers * middle + self.phases
        parts, factors, size = (np.sin(angle), np.cos(angle)), self.amplitudes, self.wave_numbers[-1] * reach
        coefficients, order, bound = [], 0, 1.0
        while bound > 1e-20:
            sign = -1.0 if order % 4 > 1 else 1.0
            coefficients.append(sign * float(factors @ parts[order % 2]) / math.factorial(order))
            factors, order = factors * self.wave_numbers, order + 1
            bound *= size / order
        coefficients[0] -= self.origin

        def polynomial(s):
            height = slope = 0.0
            for coefficient in reversed(coefficients):
                slope = slope * (s - middle) + height
                height = height * (s - middle) + coefficient
            return height, slope
        return polynomial


class Road:
    """Called as road(t, branch): `branch` is the time that selects the piece of the formula,
    so that a piece can be evaluated up to and including its ends."""

    outputs = ["position", "velocity"]

    def __init__(self, parameters, settings, track=0):
        self.p, self.start, self.kind = parameters, parameters.get("start_time", 0.0), settings["kind"]
        self.profile = None
        if self.kind == "Iso8608":
            self.profile = IsoProfile(settings["iso_class"], settings["seed"], track)

    def __call__(self, t, branch=None):
        tau = t - self.start
        select = (t if branch is None else branch) - self.start
        if select < 0.0:
            return 0.0, 0.0
        return getattr(self, self.kind)(tau, select, self.p)

    def piece(self, a, b):
        """A function of time that is the road's motion between a and b, where there is no break."""
        middle = 0.5 * (a + b)
        if self.kind != "Iso8608" or middle < self.start:
            return lambda t: self(t, middle)
        speed = self.p["speed"]
        near = self.profile.near(speed * (middle - self.start), 0.5 * speed * (b - a))

        def motion(t):
            height, slope = near(speed * (t - self.start))
            return height, slope * speed
        return motion

    def Sine(self, tau, _select, p):
        w = 2.0 * math.pi * p["frequency"]
        return p["amplitude"] * math.sin(w * tau), p["amplitude"] * w * math.cos(w * tau)

    def Square(self, tau, select, p):
        half = 0.5 / p["frequency"]
        k = math.floor(select / half)
        target = p["amplitude"] if k % 2 == 0 else -p["amplitude"]
        origin = 0.0 if k == 0 else -target
        return edge(tau - k * half, select - k * half, origin, target, p["edge_time"])

    def Step(self, tau, select, p):
        return edge(tau, select, 0.0, p["step.height"], p["edge_time"])

    def Chirp(self, tau, select, p):
        f0, f1, duration = p["chirp.start_frequency"], p["chirp.end_frequency"], p["chirp.duration"]
        if select <= duration:
            phase = 2.0 * math.pi * (f0 * tau + (f1 - f0) * tau * tau / (2.0 * duration))
            frequency = f0 + (f1 - f0) * tau / duration
        else:
            phase = 2.0 * math.pi * (0.5 * (f0 + f1) * duration + f1 * (tau - duration))
            frequency = f1
        a = p["amplitude"]
        return a * math.sin(phase), a * 2.0 * math.pi * frequency * math.cos(phase)

    def FrequencyRamp(self, tau, _select, p):
        a, rate = p["amplitude"], p["ramp.rate"]
        phase = math.pi * rate * tau * tau
        return a * math.sin(phase), a * 2.0 * math.pi * rate * tau * math.cos(phase)

    def Bump(self, tau, select, p):
        if select > p["bump.length"] / p["speed"]:
            return 0.0, 0.0
        w = 2.0 * math.pi * p["speed"] / p["bump.length"]
        return (0.5 * p["bump.height"] * (1.0 - math.cos(w * tau)),
                0.5 * p["bump.height"] * w * math.sin(w * tau))

    def Iso8608(self, tau, _select, p):
        height, slope = self.profile(p["speed"] * tau)
        return height, slope * p["speed"]

    def breaks(self, stop):
        """Times where the formula changes its piece."""
        marks = [0.0]
        if self.kind in ("Square", "Step"):
            half = 0.5 / self.p["frequency"] if self.kind == "Square" else math.inf
            begin = 0.0
            k = 0
            while begin <= stop:
                marks += [begin, begin + self.p["edge_time"]]
                k += 1
                begin = k * half
        if self.kind == "Chirp":
            marks.append(self.p["chirp.duration"])
        if self.kind == "Bump":
            marks.append(self.p["bump.length"] / self.p["speed"])
        return sorted({self.start + mark for mark in marks})


class FourWheelRoad:
    outputs = [f"{wheel}.{what}" for wheel in ("front_left", "front_right", "rear_left", "rear_right")
               for what in Road.outputs]

    def __init__(self, parameters, settings):
        own = {name.removeprefix("profile."): value for name, value in parameters.items()}
        tracks = (0, 0) if settings.get("same_track") else (0, 1)
        self.tracks = [Road(own, settings, track) for track in tracks]
        self.delay = own["wheelbase"] / own["speed"]

    def __call__(self, t):
        return [value for time in (t, t - self.delay) for track in self.tracks for value in track(time)]

    def breaks(self, stop):
        front = self.tracks[0].breaks(stop)
        return sorted({*front, *(mark + self.delay for mark in front)})


def edge(tau, select, origin, target, duration):
    if select >= duration:
        return target, 0.0
    w = math.pi / duration
    return (origin + (target - origin) * 0.5 * (1.0 - math.cos(w * tau)),
            (target - origin) * 0.5 * w * math.sin(w * tau))
