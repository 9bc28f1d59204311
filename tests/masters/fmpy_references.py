"""FMUs through FMPy against the independent references in tests/reference.

    python fmpy_references.py FOLDER [CASE ...]     # every single-model case, or some
"""

import csv
import json
import sys
import zipfile
from pathlib import Path

import numpy as np
from rig import Fmu

REFERENCE = Path(__file__).parent.parent / "reference"
sys.path.insert(0, str(REFERENCE))
import stimulus  # noqa: E402

# A bench without states: strut and tyre are those of the rigs, and what it shows stands on the reproduction page. A record
# from a file, which has none until a parameter set brings it: its unit test has numpy's numbers.
WITHOUT = {"ElementDyno", "RecordedSource"}


def load(path):
    case = json.loads(path.read_text())
    with path.with_suffix(".csv").open() as file:
        rows = np.array([[float(value) for value in row] for row in list(csv.reader(file))[1:]])
    return case, rows


def start_values(fmu, case):
    """Settings, changed parameters and states, as values to set."""
    start = case.get("changed", {}) | case.get("start", {})
    for name, value in case.get("settings", {}).items():
        items = getattr(fmu.variables[name].declaredType, "items", None)
        start[name] = next(int(item.value) for item in items if item.name == value) if items else value
    return start


def check_parameters(fmu, instance, case):
    """The parameters are the FMU's own: a reference that disagrees with them is an error here."""
    for name, value in case.get("parameters", {}).items():
        if name not in case.get("changed", {}):
            held = instance.getReal(fmu.reference(name))[0]
            assert abs(held - value) <= 1e-12 * abs(value), (name, held, value)


def run(fmu, case, rows):
    """What the FMU shows where the reference has its rows."""
    columns = fmu.reference(*case["columns"][1:])
    with fmu.running(start=start_values(fmu, case)) as instance:
        check_parameters(fmu, instance, case)
        recorded = []
        if "step" in case:
            step, inputs = case["step"], fmu.reference(*case["inputs"])
            for index in range(round(case["stop"] / step) + 1):
                if index:
                    instance.doStep(currentCommunicationPoint=(index - 1) * step, communicationStepSize=step)
                else:
                    instance.setReal(inputs, list(stimulus.inputs_at(case, 0.0).values()))
                if index % case["rows_every"] == 0:
                    recorded.append(instance.getReal(columns))
                instance.setReal(inputs, list(stimulus.inputs_at(case, index * step).values()))
        else:
            time = 0.0
            for next_time in rows[:, 0]:
                if next_time > time:
                    instance.doStep(currentCommunicationPoint=time, communicationStepSize=next_time - time)
                    time = next_time
                recorded.append(instance.getReal(columns))
    recorded = np.array(recorded)
    assert recorded.shape == rows[:, 1:].shape, (recorded.shape, rows.shape)
    return recorded


def compare(folder, case, rows):
    """Largest error, relative to the column's scale, and where it is."""
    fmu = Fmu(folder / f"{case['package']}.fmu")
    error = np.abs(run(fmu, case, rows) - rows[:, 1:]).max(axis=0)
    scaled = {name: value / case["scale"][name] for name, value in zip(case["columns"][1:], error)}
    fmu.close()
    worst = max(scaled, key=scaled.get)
    assert scaled[worst] < case["error"], f"{worst}: {scaled[worst]:.2e}"
    return scaled[worst], worst


def check_complete(folder, models):
    """Every model has a case; one whose cases stand in no list would be missed by nobody else."""
    built = {path.stem for path in folder.glob("*.fmu") if not has_parameter_set(path)}
    assert built == models | WITHOUT, f"models without a reference, or references without a model: {built ^ models}"


def has_parameter_set(path):
    with zipfile.ZipFile(path) as archive:
        return "resources/parameters.toml" in archive.namelist()


def main():
    folder, chosen = Path(sys.argv[1]), sys.argv[2:]
    models = set()
    for path in sorted((REFERENCE / "cases").glob("*.json")):
        case, rows = load(path)
        if case["kind"] != "coupled" and (not chosen or path.stem in chosen):
            models.add(case["fmu"])
            try:
                worst, name = compare(folder, case, rows)
            except Exception as error:
                raise AssertionError(path.stem) from error
            count = len(case["columns"]) - 1
            print(f"{path.stem}: {count} signals, largest error {worst:.1e} of the signal's scale ({name})")
    if not chosen:
        check_complete(folder, models)


if __name__ == "__main__":
    main()
