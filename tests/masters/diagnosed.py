"""The extended model of a diagnosis, through FMPy on the held-out records.

    python diagnosed.py REPORT RECORDS     # the folder of the report, that of the records

Whoever runs `extended.fmu` on a held-out record finds the errors that `report.json` tells.
"""

import csv
import json
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from rig import Fmu

# The diagnosis integrates by Runge and Kutta's classical method with the record's step, the FMU with error control at
# 1e-8. What the methods differ by is orders below the noise that is left; in a root mean square it counts squared where
# it does not resemble the noise, and in proportion where it does.
BOUND = 1e-3
# What the bound must be able to see: the same model without what the diagnosis has added.
SEEN = 10 * BOUND
NAMESPACE = "{http://ssp-standard.org/SSP1/SystemStructureParameterValues}"


def read(path):
    """Time and signals of a record in the FMU's names and units."""
    with path.open(encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    columns = np.array(rows, dtype=float).T
    signals = {title.split(" [")[0]: column for title, column in zip(header, columns)}
    return signals.pop("time"), signals


def derivative(signal, step):
    """By central differences, at the ends by one-sided ones."""
    return np.gradient(signal, step, edge_order=1)


def inputs(fmu, signals, step):
    """The FMU's inputs at the samples; a velocity that was not recorded is the derivative of its position."""
    rows = []
    for name in (variable.name for variable in fmu.inputs):
        if name not in signals:
            signals[name] = derivative(signals[name.removesuffix("velocity") + "position"], step)
        rows.append(signals[name])
    return np.array(rows).T


def simulate(fmu, rows, step, start, names):
    """The outputs at the samples; between them the inputs go straight."""
    columns, driven = fmu.reference(*names), [variable.valueReference for variable in fmu.inputs]
    order = [1] * len(driven)
    recorded = []
    with fmu.running(start=start | {v.name: value for v, value in zip(fmu.inputs, rows[0])}) as instance:
        for index, (row, following) in enumerate(zip(rows, [*rows[1:], None])):
            instance.setReal(driven, list(row))
            recorded.append(instance.getReal(columns))
            if following is not None:
                instance.setRealInputDerivatives(driven, order, list((following - row) / step))
                instance.doStep(currentCommunicationPoint=index * step, communicationStepSize=step)
    return np.array(recorded).T


def errors(fmu, report, folder, changed):
    """Root mean square of each signal's error over all held-out stretches."""
    names = [signal["name"] for signal in report["signals"]]
    left = [[] for _ in names]
    for stretch in report["starts"]:
        time, signals = read(folder / stretch["record"])
        step = (time[-1] - time[0]) / (len(time) - 1)
        first, last = round(stretch["time"] / step), round(stretch["end"] / step)
        rows = inputs(fmu, signals, step)[first:last]
        simulated = simulate(fmu, rows, step, stretch["states"] | changed, names)
        for errors_of_one, name, values in zip(left, names, simulated):
            errors_of_one.extend(signals[name][first:last] - values)
    return {name: float(np.sqrt(np.mean(np.square(values)))) for name, values in zip(names, left)}


def check_errors(fmu, report, folder):
    """What the report tells comes out; and it would not, were what was added not in the FMU."""
    told = {signal["name"]: signal["rms_after"] for signal in report["signals"]}
    found = errors(fmu, report, folder, {})
    for name, value in found.items():
        difference = abs(value / told[name] - 1.0)
        print(f"{name}: {value:.6g}, told {told[name]:.6g}, relative difference {difference:.1e}")
        assert difference < BOUND, f"{name}: the error is {value}, the report tells {told[name]}"
    first = report["effects"][0]["parameters"][0]["name"]
    without = errors(fmu, report, folder, {first: 0.0})
    most = max(abs(value / told[name] - 1.0) for name, value in without.items())
    print(f"without {first}: relative difference up to {most:.1e}")
    assert most > SEEN, f"the errors are the same without {first}"


def check_parameter_set(fmu, path):
    """`extended.ssv` names parameters of the FMU with the values that it starts with."""
    root = ElementTree.parse(path).getroot()
    assert root.tag == NAMESPACE + "ParameterSet", root.tag
    assert root.get("version") == "1.0" and root.get("name")
    parameters = root.findall(f"{NAMESPACE}Parameters/{NAMESPACE}Parameter")
    assert parameters, "the parameter set is empty"
    for parameter in parameters:
        variable = fmu.variables[parameter.get("name")]
        value = float(parameter.find(NAMESPACE + "Real").get("value"))
        assert variable.causality == "parameter", variable.name
        assert value == float(variable.start), (variable.name, value, variable.start)
    print(f"{path.name}: {len(parameters)} parameters")


def main():
    folder, records = map(Path, sys.argv[1:])
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    assert report["signals"] and report["starts"], "the report tells no errors"
    fmu = Fmu(folder / "extended.fmu")
    check_errors(fmu, report, records)
    check_parameter_set(fmu, folder / "extended.ssv")
    fmu.close()


if __name__ == "__main__":
    main()
