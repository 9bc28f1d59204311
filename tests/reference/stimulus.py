"""Evaluates the input formula of a case file.

A case describes each input by a list of sines and a list of steps,

    value(t) = sum a sin(2 pi f t + phi)  +  sum height [t >= at]

    {"sines": [[a, f, phi], ...], "steps": [[height, at], ...]}

with a in the unit of the input, f in Hz, phi in rad, at in s.
Between two communication points t_k = k * step the input keeps value(t_k).
Only the standard library is used, so that any harness can import this file.
"""

import json
import math


def value(formula, t):
    """The formula's value at time t."""
    total = 0.0
    for amplitude, frequency, phase in formula.get("sines", []):
        total += amplitude * math.sin(2.0 * math.pi * frequency * t + phase)
    for height, at in formula.get("steps", []):
        if t >= at:
            total += height
    return total


def inputs_at(case, t):
    """All inputs of a case at time t, by name."""
    return {name: value(formula, t) for name, formula in case["inputs"].items()}


def communication_point(case, k):
    """The k-th communication point: a product, so no rounding accumulates."""
    return k * case["step"]


def road_sines(components):
    """Formulas for road.position and road.velocity that belong together."""
    position = [[a, f, phi] for a, f, phi in components]
    velocity = [[2.0 * math.pi * f * a, f, phi + 0.5 * math.pi] for a, f, phi in components]
    return {"sines": position, "steps": []}, {"sines": velocity, "steps": []}


def load(path):
    """Reads a case file."""
    with open(path, encoding="utf-8") as file:
        return json.load(file)
