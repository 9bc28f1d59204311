"""Signals over time, tau = t - start_time; before the start all are at their offset.

    Constant   offset
    Step       offset + A, over an edge of a cosine's half wave that takes edge_time
    Ramp       offset + r min(tau, T)
    Stairs     level k for (k - 1) T <= tau < k T, the last one held
    Sine       offset + A sin(2 pi f tau)
    Square     edges at tau = k / (2 f): to offset + A for even k, to offset - A for odd k, from offset at k = 0
    Chirp      offset + A sin(phi), phi as in `roads`
"""

import math

from roads import edge


class Source:
    def __init__(self, parameters, settings):
        self.p, self.shape = parameters, settings["shape"]
        self.start, self.offset = parameters["start_time"], parameters["offset"]

    def __call__(self, t, _branch=None):
        tau = t - self.start
        return [self.offset if tau < 0.0 else getattr(self, self.shape)(tau)]

    def piece(self, _a, _b):
        return self

    def Constant(self, _tau):
        return self.offset

    def Step(self, tau):
        return self.offset + self.edge(tau, 0.0, self.p["amplitude"])

    def edge(self, tau, origin, target):
        duration = self.p["edge_time"]
        return edge(tau, tau, origin, target, duration)[0] if duration > 0.0 else target

    def Ramp(self, tau):
        return self.offset + self.p["ramp.rate"] * min(tau, self.p["ramp.duration"])

    def Stairs(self, tau):
        level = min(math.floor(tau / self.p["stairs.duration"]), 11)
        return self.p[f"stairs.level[{level + 1}]"]

    def Sine(self, tau):
        return self.offset + self.p["amplitude"] * math.sin(2.0 * math.pi * self.p["swing_frequency"] * tau)

    def Square(self, tau):
        half, amplitude = 0.5 / self.p["swing_frequency"], self.p["amplitude"]
        k = math.floor(tau / half)
        target = amplitude if k % 2 == 0 else -amplitude
        return self.offset + self.edge(tau - k * half, 0.0 if k == 0 else -target, target)

    def Chirp(self, tau):
        f0, f1, duration = (self.p[f"chirp.{name}"] for name in ("start_frequency", "end_frequency", "duration"))
        swept, after = min(tau, duration), max(0.0, tau - duration)
        phase = f0 * swept + (f1 - f0) * swept * swept / (2.0 * duration) + f1 * after
        return self.offset + self.p["amplitude"] * math.sin(2.0 * math.pi * phase)

    def breaks(self, stop):
        """Times where the formula changes its piece."""
        marks, p = [0.0], self.p
        every = {"Stairs": p.get("stairs.duration"), "Square": 0.5 / p.get("swing_frequency", 0.5)}.get(self.shape)
        marks += [k * every for k in range(math.ceil((stop - self.start) / every))] if every else []
        marks += [mark + p["edge_time"] for mark in marks] if self.shape in ("Step", "Square") else []
        marks += [p[name] for shape, name in (("Ramp", "ramp.duration"), ("Chirp", "chirp.duration"))
                  if shape == self.shape]
        return sorted({self.start + mark for mark in marks})


class VoltageSource(Source):
    outputs = ["voltage"]


class FrequencySource(Source):
    outputs = ["frequency"]
