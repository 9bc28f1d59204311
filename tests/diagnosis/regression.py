"""A balance of forces by linear least squares: what an engineer does by hand, and the floor of a diagnosis.

`regression.py TRAIN TEST...` fits force = F0 + k x + c v + Fc sign v + m a on a record and prints the fit on the others,
1 - rms(error)/rms(force about its mean). Velocity is a column of the record, or the derivative of the position.
"""

import csv
import sys

import numpy as np


def balance(path):
    """Force and regressors of a record; rows with gaps are left out."""
    with open(path, encoding="utf-8") as file:
        header, *rows = [row for row in csv.reader(file) if row]
    names = [name.split("[")[0].strip() for name in header]
    table = np.array([[float(cell or "nan") for cell in row] for row in rows])
    column = {name: table[:, index] for index, name in enumerate(names)}
    position = next(column[name] for name in ("deflection", "motion.position", "position") if name in column)
    step = np.median(np.diff(column["time"]))
    velocity = column.get("velocity", np.gradient(position, step))
    terms = [np.ones_like(position), position, velocity, np.sign(velocity), np.gradient(velocity, step)]
    terms, force = np.column_stack(terms), column["force"]
    whole = np.isfinite(force) & np.isfinite(terms).all(axis=1)
    return force[whole], terms[whole]


def main(train, *tests):
    force, terms = balance(train)
    scale = np.abs(terms).max(axis=0)
    amounts = np.linalg.lstsq(terms / scale, force, rcond=None)[0] / scale
    force, terms = (np.concatenate(parts) for parts in zip(*map(balance, tests)))
    error = force - terms @ amounts
    print(1.0 - np.sqrt(np.mean(error**2)) / np.std(force))


main(*sys.argv[1:])
