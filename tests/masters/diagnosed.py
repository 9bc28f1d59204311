"""The extended model of a diagnosis, through FMPy on the validation records.

    python diagnosed.py REPORT RECORDS     # the folder of the report, that of the records

Whoever runs `extended.fmu` on a validation record, and lets its signals pass the `distortions`, finds the errors that
`report.json` tells.
"""

import csv
import json
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from rig import Fmu
from scipy.signal import lsim

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


def corrected(report, signals, step, first, into):
    """Signals on their way into the model, or out of it: (1 + gain) lag(y(t')) + offset + drift t, t' = (1 + rate) t - delay.

    They are bent before, y + q y² + c y³; t counts from the record's beginning, `first` samples earlier. After the lag they
    pass a step response; what comes out is held within the limit, if that is not zero.
    """
    signals = dict(signals)
    for it in (it for it in report["distortions"] if it["input"] == into and it["signal"] in signals):
        y = np.asarray(signals[it["signal"]], dtype=float)
        y = y * (1.0 + y * (it["quadratic"] + y * it["cubic"]))
        time = step * (first + np.arange(len(y)))
        y = lagged(delayed(y, (it["delay"] - it["rate"] * time) / step), it["lag"] / step)
        y = answered(y, step, [(point["after"], point["value"]) for point in it["response"]])
        y = (1.0 + it["gain"]) * y + it["offset"] + it["drift"] * time
        signals[it["signal"]] = np.clip(y, -it["limit"], it["limit"]) if it["limit"] > 0.0 else y
    return signals


def delayed(y, samples):
    """By cubic Hermite splines with the slopes of Catmull and Rom; beyond the ends, the last value."""
    at = np.arange(len(y)) - samples
    k = np.floor(at).astype(int)
    s = at - k
    a, b, c, d = (y[np.clip(k + offset, 0, len(y) - 1)] for offset in (-1, 0, 1, 2))
    start, end = (c - a) / 2.0, (d - b) / 2.0
    return (
        b * (2 * s**3 - 3 * s**2 + 1) + c * (3 * s**2 - 2 * s**3) + start * (s**3 - 2 * s**2 + s) + end * (s**3 - s**2)
    )


def lagged(y, samples):
    """A first-order lag of a signal that is straight between its samples, from rest at the first one."""
    if samples == 0.0:
        return y
    times = np.arange(len(y), dtype=float)
    return lsim(([1.0], [samples, 1.0]), y - y[0], times, interp=True)[1] + y[0]


def answered(y, step, points):
    """With a step response that is straight between its points, of a signal that rested at its first value before.

    Between two points the step response rises evenly: the signal's mean over the delays between them counts by that rise.
    """
    if not points:
        return y
    times = step * np.arange(len(y))
    areas = step * np.concatenate(([0.0], np.cumsum(0.5 * (y[1:] + y[:-1]))))

    def area(delay):
        at = times - delay
        return np.where(at < 0.0, y[0] * at, np.interp(at, times, areas))

    (after, value), *further = points
    result = value * y
    for later, higher in further:
        result = result + (higher - value) * (area(after) - area(later)) / (later - after)
        after, value = later, higher
    return result


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
    """Root mean square of each signal's error over all validation segments."""
    names = [signal["name"] for signal in report["signals"]]
    left = [[] for _ in names]
    for stretch in report["initial_states"]:
        time, signals = read(folder / stretch["record"])
        step = (time[-1] - time[0]) / (len(time) - 1)
        first, last = round(stretch["time"] / step), round(stretch["end"] / step)
        signals = {name: values[first:last] for name, values in signals.items()}
        rows = inputs(fmu, corrected(report, signals, step, first, True), step)
        simulated = dict(zip(names, simulate(fmu, rows, step, stretch["states"] | changed, names)))
        simulated = corrected(report, simulated, step, first, False)
        for errors_of_one, name in zip(left, names):
            errors_of_one.extend(signals[name] - simulated[name])
    return {name: float(np.sqrt(np.mean(np.square(values)))) for name, values in zip(names, left)}


def check_errors(fmu, report, folder):
    """What the report tells comes out; and it would not without what was found first, in the FMU or outside of it."""
    told = {signal["name"]: signal["rms_after"] for signal in report["signals"]}
    found = errors(fmu, report, folder, {})
    for name, value in found.items():
        difference = abs(value / told[name] - 1.0)
        print(f"{name}: {value:.6g}, told {told[name]:.6g}, relative difference {difference:.1e}")
        assert difference < BOUND, f"{name}: the error is {value}, the report tells {told[name]}"
    if report["effects"]:
        first, place = report["effects"][0]["parameters"][0]["name"], report["effects"][0]["element"]
    else:
        first = place = report["unmodelled"][0]["place"]
    others = [it for it in report["distortions"] if it["signal"] != place]
    if len(others) < len(report["distortions"]):
        without = errors(fmu, report | {"distortions": others}, folder, {})
    else:
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
    assert report["signals"] and report["initial_states"], "the report tells no errors"
    fmu = Fmu(folder / "extended.fmu")
    check_errors(fmu, report, records)
    check_parameter_set(fmu, folder / "extended.ssv")
    fmu.close()


if __name__ == "__main__":
    main()
