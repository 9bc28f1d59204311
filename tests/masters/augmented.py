"""An augmented model in our master, FMPy, libcosimpy and Ecos: it meets the validation record as its report states.

    python augmented.py REPORT RECORD.csv SIGNAL=COMPONENT.VARIABLE...

REPORT is the folder of a diagnosis. A signal's fit may be off by what the communication step is chosen for: one per cent of an
oscillation's damping, which changes a motion by one per cent of itself at most.
"""

import csv
import json
import re
import sys
import zipfile
from pathlib import Path

import numpy as np
from connected import MASTERS

sys.path.insert(0, str(Path(__file__).parent.parent.parent / "examples"))
from ssp import open_system  # noqa: E402

WITHIN = 0.01
# Masters in Python take some seconds for a second of the record, and Ecos for all of it.
SECOND = 1.0


def fmpy(path, step, count, signals):
    """With the model's start values, which FMPy takes from its caller and not from the file."""
    from fmpy.ssp.simulation import simulate_ssp
    from fmpy.ssp.ssd import read_ssv

    values = read_ssv(str(path), "resources/model.ssv")
    for parameter in values.parameters:
        parameter.name = f"model.{parameter.name}"
    result = simulate_ssp(str(path), stop_time=(count - 0.5) * step, step_size=step, parameter_set=values)
    return {name: np.concatenate([[np.nan], result[name]]) for name in signals if name in result.dtype.names}


def own(path, step, count, signals):
    with open_system(path.parent, path.stem) as system:
        return system.run(count * step, step, signals)


def fit(measured, found):
    """The fit of a signal, from the second sample on: not every master has a row for the start."""
    left, moved = (measured - found)[1:], measured[1:] - measured[1:].mean()
    return 1.0 - np.sqrt(np.mean(left**2) / np.mean(moved**2))


def main():
    report, record, named = Path(sys.argv[1]), Path(sys.argv[2]), dict(word.split("=") for word in sys.argv[3:])
    path = report / "augmented.ssp"
    stated = {signal["name"]: signal["fit_after"] for signal in json.loads((report / "report.json").read_text())["signals"]}
    with open(record) as file:
        names = [name.split(" [")[0] for name in next(csv.reader(file))]
        columns = dict(zip(names, np.loadtxt(file, delimiter=",").T, strict=True))
    step = float(re.search(rb'baseStepSize="([^"]+)"', zipfile.ZipFile(path).read("SystemStructure.ssd"))[1])
    time = columns["time"]
    every = round((time[1] - time[0]) / step)
    for name, master in [("ours", own), ("FMPy", fmpy)] + [(it, MASTERS[it][0]) for it in ("libcosimpy", "ecos")]:
        samples = len(time) if name == "ecos" else round(SECOND / (time[1] - time[0])) + 1
        # Ecos reads after an exchange: an acceleration there has the force of the next step, and FMPy shows connectors only.
        wanted = {signal: shown for signal, shown in named.items() if name == "ours" or shown.count(".") == 1}
        result = master(path, step, (samples - 1) * every, list(wanted.values()))
        for signal, shown in wanted.items():
            found = fit(columns[signal][:samples], result[shown][::every])
            print(f"{name}: {signal} fits {found:.4f} for {samples} samples, {stated[signal]:.4f} by the report")
            assert abs(found - stated[signal]) <= WITHIN, (name, signal, found)


if __name__ == "__main__":
    main()
