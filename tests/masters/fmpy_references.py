"""FMUs through FMPy against the independent references in tests/reference.

    python fmpy_references.py FOLDER          # every single-model case
"""

import csv
import json
import sys
from pathlib import Path

import numpy as np
from rig import Fmu

REFERENCE = Path(__file__).parent.parent / "reference"
sys.path.insert(0, str(REFERENCE))
import stimulus  # noqa: E402

# Which FMU a parameter set of the references is.
FMUS = {
    "quanser": "QuanserQuarterCar",
    "quanser-table-3-1": "QuanserTable31QuarterCar",
    "konieczny": "KoniecznyQuarterCar",
    "ajala": "AjalaQuarterCar",
    "tum-linear-optimised": "TumLinearOptimisedQuarterCar",
    "tum-linear-measured": "TumLinearMeasuredQuarterCar",
    "tum-table-7-optimised": "TumTable7OptimisedQuarterVehicle",
    "tum-table-7-measured": "TumTable7MeasuredQuarterVehicle",
    "tum-table-10": "TumQuarterVehicle",
}

# The references' names of the roads' parameters and kinds, and the FMU's.
ROAD_KINDS = {
    "sine": "Sine", "square": "Square", "chirp": "Chirp", "frequency_ramp": "FrequencyRamp", "step": "Step",
    "bump": "Bump", "iso8608": "Iso8608",
}  # fmt: skip


def load(path):
    case = json.loads(path.read_text())
    with path.with_suffix(".csv").open() as file:
        rows = np.array([[float(value) for value in row] for row in list(csv.reader(file))[1:]])
    return case, rows


def compare(case, rows, name, times, values, tolerance=1e-6):
    """Largest error relative to the column's scale."""
    expected = np.interp(times, rows[:, 0], rows[:, case["columns"].index(name)])
    error = np.abs(np.asarray(values) - expected).max() / case["scale"][name]
    assert error < tolerance, f"{name}: {error:.2e}"
    return error


def single(folder, case, rows):
    fmu = Fmu(folder / f"{FMUS.get(case.get('parameter_set'), case['fmu'])}.fmu")
    columns = [name for name in case["columns"] if name in fmu.variables]
    references = fmu.reference(*columns)
    inputs = fmu.reference(*case["inputs"])
    step, recorded, count = case["step"], [], round(case["stop"] / case["step"])
    start = {name: value for name, value in case["start"].items() if name in fmu.variables}
    with fmu.running(start=start) as instance:
        # The parameters are the FMU's own: a reference that disagrees with them is an error here.
        for name, value in case["parameters"].items() if case["fmu"] == "QuarterCar" else ():
            held = instance.getReal(fmu.reference(name))[0]
            assert abs(held - value) <= 1e-12 * abs(value), (name, held, value)
        for index in range(count + 1):
            if index == 0:
                instance.setReal(inputs, list(stimulus.inputs_at(case, 0.0).values()))
            if index % case["rows_every"] == 0:
                recorded.append(instance.getReal(references))
            if index < count:
                instance.setReal(inputs, list(stimulus.inputs_at(case, index * step).values()))
                instance.doStep(currentCommunicationPoint=index * step, communicationStepSize=step)
    recorded = np.array(recorded)
    assert len(recorded) == len(rows), (len(recorded), len(rows))
    worst = max(compare(case, rows, name, rows[:, 0], recorded[:, i]) for i, name in enumerate(columns) if name != "time")
    fmu.close()
    return worst, len(columns)


def road(folder, case, rows):
    fmu = Fmu(folder / "Road.fmu")
    kinds = {item.name: int(item.value) for item in enumeration(fmu, "kind")}
    classes = {item.name: int(item.value) for item in enumeration(fmu, "iso_class")}
    start = {"kind": kinds[ROAD_KINDS[case["road_kind"]]]}
    for name, value in case["parameters"].items():
        own = road_parameter(case["road_kind"], name)
        start[own] = classes[value] if own == "iso_class" else value
    worst = 0.0
    with fmu.running(start=start) as instance:
        values, time = [], 0.0
        for next_time in rows[:, 0]:
            if next_time > time:
                instance.doStep(currentCommunicationPoint=time, communicationStepSize=next_time - time)
                time = next_time
            values.append(instance.getReal(fmu.reference("position", "velocity")))
    for i, name in enumerate(("road.position", "road.velocity")):
        worst = max(worst, compare(case, rows, name, rows[:, 0], np.array(values)[:, i], 1e-9))
    fmu.close()
    return worst, 2


def enumeration(fmu, name):
    return fmu.variables[name].declaredType.items


def road_parameter(kind, name):
    """The FMU's name of a reference's road parameter."""
    own = {"start": "start_time", "road_class": "iso_class", "rate": "ramp.rate"}
    if kind == "chirp" and name not in ("amplitude", "start"):
        return f"chirp.{name}"
    if (kind, name) in (("step", "amplitude"), ("bump", "height"), ("bump", "length")):
        return f"{kind}.{name}".replace("amplitude", "height")
    return own.get(name, name)


def static(folder, case, rows):
    """Sampled control laws: the force follows from the inputs of the tick."""
    name = {"LqrController": "QuanserLqrController"}.get(case["fmu"], case["fmu"])
    fmu = Fmu(folder / f"{name}.fmu")
    inputs = fmu.reference(*case["inputs"])
    start = {"switch_on_time": case["switch_on_time"]} if "switch_on_time" in case else {}
    start |= {"damping": case["damping"]} if "damping" in case else {}
    forces = []
    with fmu.running(start=start) as instance:
        for index in range(round(case["stop"] / case["step"]) + 1):
            time = index * case["step"]
            instance.setReal(inputs, list(stimulus.inputs_at(case, time).values()))
            instance.doStep(currentCommunicationPoint=time, communicationStepSize=case["step"])
            if index % case["rows_every"] == 0:
                forces.append(instance.getReal(fmu.reference("force"))[0])
    fmu.close()
    return compare(case, rows, "force", rows[:, 0], forces, 1e-9), 1


def main():
    folder = Path(sys.argv[1])
    kinds = {"single": single, "road": road, "static": static}
    for path in sorted((REFERENCE / "cases").glob("*.json")):
        case, rows = load(path)
        if case["kind"] in kinds:
            try:
                worst, columns = kinds[case["kind"]](folder, case, rows)
            except Exception as error:
                raise AssertionError(path.stem) from error
            print(f"{path.stem}: {columns} signals, largest error {worst:.1e} of the signal's scale")


if __name__ == "__main__":
    main()
