#!/usr/bin/env python3
"""Sparse regression on the same physical terms, to compare with: no simulation, no hidden states, no held-out data.

    sparse_regression.py --parameters SET --train A.csv ... --test B.csv ... --out DIR

Takes the arguments of a diagnosis of the quarter car and writes report.json. Two balances of forces are regressed, the
body's and that of both masses,

    F_act   = m_s a_s + k x + d v + sum of terms over x, v, v_s, F_act'
    F_wheel = m_s a_s + m_u a_u + sum of terms over v_s, v_u

with velocities by a Savitzky-Golay filter and by integration; terms that contribute little are dropped one after the other and
the others regressed again (sequentially thresholded least squares, S. L. Brunton et al., PNAS 113, 2016).

Needs numpy and scipy.
"""

import argparse
import json
from pathlib import Path

import numpy as np
from scipy.signal import butter, savgol_filter, sosfiltfilt

# Contribution of a term, over what the balance leaves without any term, below which it is dropped. Chosen on the compact list.
THRESHOLD = 0.45
# Velocity over which friction changes its sign, in m/s.
SLOW = 0.008


def read(path):
    names = [name.split(" [")[0] for name in path.read_text().partition("\n")[0].split(",")]
    return dict(zip(names, np.loadtxt(path, delimiter=",", skiprows=1, unpack=True)))


def derivative(values, step):
    return savgol_filter(values, 2 * round(0.004 / step / 2) + 5, 3, deriv=1, delta=step)


def integral(values, step):
    """Without what drifts."""
    high = butter(2, 0.2, "highpass", fs=1.0 / step, output="sos")
    return sosfiltfilt(high, np.cumsum(values - values.mean()) * step)


def dead_zone(values, width):
    return values - np.clip(values, -width, width)


def balances(record):
    """The two balances: target, columns that are always there, and terms by number and place."""
    step = np.median(np.diff(record["time"]))
    x, force = record["suspension.deflection"], record["actuator.force"]
    body, wheel = record["body.acceleration"], record["wheel.acceleration"]
    v, v_s = derivative(x, step), integral(body, step)
    v_u = v_s - v
    reach = np.quantile(np.abs(x - np.median(x)), 0.85)
    strut = {
        ("01", "strut"): [np.tanh(v / SLOW)],
        ("04", "strut"): [np.abs(v)],
        ("05", "strut"): [dead_zone(v, np.quantile(np.abs(v), 0.7))],
        ("06", "strut"): [v * np.abs(v)],
        ("08", "strut"): [x**2, x**3],
        ("09", "strut"): [dead_zone(x - np.median(x), reach)],
        ("33", "strut"): [np.ones_like(x)],
        ("23", "actuator.force"): [derivative(force, step)],
    }
    guide = {
        ("15", "guide"): [v_s],
        ("16", "guide"): [np.tanh(v_s / SLOW)],
    }
    wheels = {
        ("15", "wheel_guide"): [v_u],
        ("17", "wheel_guide"): [np.tanh(v_u / SLOW)],
    }
    yield force, [body, x, v], strut | guide
    if "wheel.force" in record:
        yield record["wheel.force"], [body, wheel], guide | wheels


def thresholded(target, always, terms):
    """Contributions of the terms that stay, over what is left without any."""
    def regress(names):
        columns = [*always, *(column for name in names for column in terms[name])]
        matrix = np.column_stack(columns)
        scale = np.linalg.norm(matrix, axis=0)
        return np.linalg.lstsq(matrix / scale, target, rcond=None)[0] / scale, matrix

    amounts, matrix = regress([])
    left = np.std(target - matrix @ amounts)
    names = list(terms)
    while names:
        amounts, matrix = regress(names)
        at, contributions = len(always), {}
        for name in names:
            count = len(terms[name])
            contributions[name] = np.std(matrix[:, at : at + count] @ amounts[at : at + count]) / left
            at += count
        least = min(names, key=contributions.get)
        if contributions[least] >= THRESHOLD:
            return contributions
        names.remove(least)
    return {}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--parameters", type=Path)
    parser.add_argument("--train", type=Path, nargs="+", required=True)
    parser.add_argument("--test", type=Path, nargs="+", required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--no-fmu", action="store_true")
    arguments = parser.parse_args()
    # Of each balance, all records' rows below each other.
    stacked = {}
    for record in map(read, arguments.train):
        for number, (target, always, terms) in enumerate(balances(record)):
            targets, columns, of_terms = stacked.setdefault(number, ([], [], []))
            targets.append(target)
            columns.append(always)
            of_terms.append(terms)
    found = {}
    for targets, columns, of_terms in stacked.values():
        always = [np.concatenate(parts) for parts in zip(*columns)]
        terms = {
            name: [np.concatenate(parts) for parts in zip(*(terms[name] for terms in of_terms))] for name in of_terms[0]
        }
        for name, share in thresholded(np.concatenate(targets), always, terms).items():
            found[name] = max(share, found.get(name, 0.0))
    effects = [
        {"id": number, "element": place, "contribution": found[number, place]}
        for number, place in sorted(found, key=found.get, reverse=True)
    ]
    arguments.out.mkdir(parents=True, exist_ok=True)
    report = {"verdict": "named" if effects else "no_effect", "effects": effects}
    (arguments.out / "report.json").write_text(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
