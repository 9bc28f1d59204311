"""Makes the reference data of this folder, or compares it with a fresh computation (--check).

    python make_references.py            writes cases/ and numbers.json
    python make_references.py --check    recomputes and compares; the exit status tells
    python make_references.py NAME ...   only these cases

Needs Python 3.10 or later, numpy and scipy.
"""

import argparse
import json
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

import coupled
import sanity
from cases import CONTROLLERS, ROADS, SINGLE
from integrate import CHECK, REFERENCE, held
from models import LinearMotor, QuarterCar
from number_sheet import numbers
from parameter_sets import SETS
from roads import Road
from stimulus import inputs_at

HERE = Path(__file__).parent
# Two methods must agree this well, relative to a column's largest value.
AGREEMENT = 1e-9
# A fresh computation on another machine may differ this much from the committed one.
REPRODUCTION = 1e-9


def single(case, solver):
    if case["fmu"] == "QuarterCar":
        model = QuarterCar(case["parameters"], case["settings"]["tire.lift_off"])
    else:
        model = LinearMotor(case["parameters"])
    start = [case["start"][name] for name in model.states]
    rows, modes = [], {}
    for k, (t, state, u) in enumerate(held(model, case, start, inputs_at, solver)):
        mode = model.mode(state, u)
        modes[mode] = modes.get(mode, 0) + 1
        if k % case["rows_every"] == 0:
            rows.append([t, *state, *model.output(state, u, mode)])
    return ["time", *case["states"], *case["outputs"]], rows, {"points_by_mode": modes}


def solve(job):
    """One case by one method: (names, rows, remarks)."""
    case, solver = job
    if case["kind"] == "single":
        return single(case, solver)
    return {"quanser-lqr": coupled.quanser_lqr, "tum-active": coupled.tum_active}[case["case"]](case, solver)


def road(case):
    # The odd offset keeps rows off the edges, where the velocity has two values.
    times = (np.arange(case["rows"]) + 0.37) * case["stop"] / case["rows"]
    if case["road_kind"] in ("square", "step", "bump"):
        function = Road(case["road_kind"], **case["parameters"])
        inside = [m + s for m in function.breaks(case["stop"])[:6] for s in (0.0007, 0.0051, 0.0113)]
        times = np.sort(np.concatenate([times, inside]))
    function = Road(case["road_kind"], **case["parameters"])
    times = [float(f"{t:.9g}") for t in times]
    return ["time", "road.position", "road.velocity"], [[t, *function(t)] for t in times]


def static(case):
    if case["fmu"] == "LqrController":
        gain, _ = coupled.lqr_gain(SETS[case["parameter_set"]])
        begin = round(case["switch_on_time"] / case["step"])
    else:
        gain, begin = [case["damping"]], 0
    rows = []
    for k in range(0, round(case["stop"] / case["step"]) + 1, case["rows_every"]):
        values = list(inputs_at(case, k * case["step"]).values())
        force = -sum(g * v for g, v in zip(gain, values)) if k >= begin else 0.0
        rows.append([k * case["step"], *values, force])
    return ["time", *case["inputs"], "force"], rows


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
    scale = dict(zip(names, np.abs(np.array(rows)).max(axis=0).tolist()))
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
    arguments = parser.parse_args()
    chosen = [c for c in [coupled.TUM_ACTIVE, coupled.QUANSER_LQR, *SINGLE, *ROADS, *CONTROLLERS]
              if not arguments.cases or c["case"] in arguments.cases]
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
        if case["kind"] in ("road", "static"):
            complaints += finish(case, *(road(case) if case["kind"] == "road" else static(case)), arguments.check)

    if not arguments.cases:
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
