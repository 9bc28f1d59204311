"""Makes the reference data of this folder, or compares it with a fresh computation (--check).

    python make_references.py            writes cases/ and numbers.json
    python make_references.py --check    recomputes and compares; the exit status tells
    python make_references.py NAME ...   only these cases

Needs Python 3.10 or later, numpy and scipy.
"""

import argparse
import json
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

import sanity
import systems
from catalogue import CASES, model_of
from integrate import CHECK, REFERENCE, held
from number_sheet import numbers
from stimulus import inputs_at

HERE = Path(__file__).parent
# Two methods must agree this well, relative to a column's largest value.
AGREEMENT = 1e-9
# A fresh computation on another machine may differ this much from the committed one.
REPRODUCTION = 1e-9


def single(case, solver):
    model = model_of(case)
    start = [case["start"].get(name, 0.0) for name in model.states]
    rows, modes = [], {}
    for k, (t, state, u) in enumerate(held(model, case, start, inputs_at, solver)):
        mode = model.mode(state, u)
        if mode != ():
            modes[str(mode)] = modes.get(str(mode), 0) + 1
        if k % case["rows_every"] == 0:
            rows.append([t, *(state if model.shown else []), *model.output(state, u, mode)])
    # Tables have many modes: their number is enough.
    remarks = {"points_by_mode": modes} if len(modes) < 8 else {"modes": len(modes)}
    return ["time", *(model.states if model.shown else []), *model.outputs], rows, remarks


def solve(job):
    """One case by one method: (names, rows, remarks)."""
    case, solver = job
    return single(case, solver) if case["kind"] == "single" else systems.solve(case["case"], solver)


def times(case):
    """A function of time, at times on no edge, where it may have two values: hence the odd offset."""
    function = model_of(case)
    at = (np.arange(case["rows"]) + 0.37) * case["stop"] / case["rows"]
    near = [mark + after for mark in function.breaks(case["stop"])[:6] for after in (0.0007, 0.0051, 0.0113)]
    at = [float(f"{t:.9g}") for t in np.sort(np.concatenate([at, near])) if t <= case["stop"]]
    return ["time", *function.outputs], [[t, *function(t)] for t in at]


def difference(names, rows, others):
    """Largest difference of two tables by column, relative to the column's largest value."""
    a, b = np.array(rows), np.array(others)
    if a.shape != b.shape:
        return {"shape": float("inf")}
    scale = np.maximum(np.abs(a).max(axis=0), 1e-300)
    return dict(zip(names, (np.abs(a - b).max(axis=0) / scale).tolist()))


def worst(differences):
    name = max(differences, key=differences.get)
    return differences[name], name


def read_table(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    return lines[0].split(","), [[float(x) for x in line.split(",")] for line in lines[1:]]


def finish(definition, names, rows, check):
    """Writes a case or compares it. Returns a list of complaints."""
    target = HERE / "cases" / definition["case"]
    # What rests throughout is compared as it is.
    scale = {name: value or 1.0 for name, value in zip(names, np.abs(np.array(rows)).max(axis=0).tolist())}
    if not check:
        document = definition | {"columns": names, "scale": {n: scale[n] for n in names[1:]}}
        target.with_suffix(".json").write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
        text = [",".join(names)] + [",".join(map(repr, row)) for row in rows]
        target.with_suffix(".csv").write_text("\n".join(text) + "\n", encoding="utf-8")
        return []
    complaints = []
    committed = json.loads(target.with_suffix(".json").read_text(encoding="utf-8"))
    for key, value in definition.items():
        if key not in ("agreement", "remarks") and committed.get(key) != json.loads(json.dumps(value)):
            complaints.append(f"{target.name}.json: {key} differs from the script")
    old_names, old_rows = read_table(target.with_suffix(".csv"))
    if old_names != names:
        return complaints + [f"{target.name}.csv: other columns than the script's"]
    value, name = worst(difference(names, old_rows, rows))
    print(f"{target.name:36} reproduced to {value:.1e} ({name})")
    if value > REPRODUCTION:
        complaints.append(f"{target.name}.csv: {name} differs by {value:.1e} of its scale")
    return complaints


def compare_numbers(old, new, path="numbers"):
    """Complaints about leaves that differ by more than a relative 1e-9."""
    if isinstance(new, dict):
        if not isinstance(old, dict) or old.keys() != new.keys():
            return [f"{path}: other entries"]
        return [c for key in new for c in compare_numbers(old[key], new[key], f"{path}.{key}")]
    if isinstance(new, list):
        if not isinstance(old, list) or len(old) != len(new):
            return [f"{path}: other length"]
        return [c for i, pair in enumerate(zip(old, new)) for c in compare_numbers(*pair, f"{path}[{i}]")]
    if isinstance(new, float):
        return [] if abs(old - new) <= 1e-9 * max(abs(old), abs(new), 1e-6) else [f"{path}: {old} became {new}"]
    return [] if old == new else [f"{path}: {old} became {new}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare with the committed files")
    parser.add_argument("cases", nargs="*", metavar="NAME", help="only these cases")
    parser.add_argument("--part", default=os.environ.get("STRUT_PART", "1/1"), metavar="K/N", help="the K-th of N parts of them")
    arguments = parser.parse_args()
    # The longest ones first: two cores are then busy to the end.
    chosen = [c for c in [*(make()[0] for make in systems.SYSTEMS.values()), *CASES]
              if not arguments.cases or c["case"] in arguments.cases]
    number, parts = map(int, arguments.part.split("/"))
    chosen = chosen[number - 1 :: parts]
    (HERE / "cases").mkdir(exist_ok=True)
    complaints = []

    integrated = [c for c in chosen if c["kind"] in ("single", "coupled")]
    with ProcessPoolExecutor() as pool:
        results = pool.map(solve, [(c, s) for c in integrated for s in (REFERENCE, CHECK)])
        for case in integrated:
            names, rows, remarks = next(results)
            _, others, other_remarks = next(results)
            value, name = worst(difference(names, rows, others))
            exact = sanity.exact_linear(case, rows) if case.get("fmu") == "QuarterCar" else None
            print(f"{case['case']:36} two methods agree to {value:.1e} ({name})"
                  + (f", with the matrix exponential to {exact:.1e}" if exact is not None else "")
                  + f"; {remarks}", flush=True)
            if value > AGREEMENT or (exact or 0.0) > AGREEMENT:
                complaints.append(f"{case['case']}: two methods differ by {max(value, exact or 0.0):.1e} in {name}")
            document = case | {"agreement": float(f"{value:.1e}"), "remarks": remarks}
            complaints += finish(document, names, rows, arguments.check)

    for case in chosen:
        if case["kind"] == "times":
            complaints += finish(case, *times(case), arguments.check)

    # Checks of all cases together belong to the first part.
    if not arguments.cases and number == 1:
        complaints += sanity.complaints()
        sheet, path = numbers(), HERE / "numbers.json"
        if arguments.check:
            complaints += compare_numbers(json.loads(path.read_text(encoding="utf-8")),
                                          json.loads(json.dumps(sheet)))
        else:
            path.write_text(json.dumps(sheet, indent=1) + "\n", encoding="utf-8")

    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
