"""What a step costs in FMI 3.0 and in FMI 2.0, in one run: the same inputs, steps and outputs by turns.

    python versions.py FOLDER [NAME...] [--before FOLDER]

FOLDER has the FMUs of FMI 2.0, and those of FMI 3.0 in its folder `fmi3`: `build-fmu --fmi 2 --fmi 3 --out FOLDER`.
With --before, FMUs of FMI 2.0 that were built earlier stand beside them.
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

from fmpy import extract, read_model_description

NAMES = [
    "QuarterCar", "TumQuarterVehicle", "AjalaFullCar", "KoniecznyServoSuspension", "LinearMotor", "KogutMrRotaryBrake",
    "QuanserLqrController",
]  # fmt: skip


def subject(path):
    """Version, library, token and resources of an FMU."""
    folder, description = Path(extract(str(path))), read_model_description(str(path))
    three = description.fmiVersion == "3.0"
    library = folder / "binaries" / ("x86_64-linux" if three else "linux64") / f"{description.modelName}.so"
    resources = folder / "resources"
    place = "" if not resources.exists() else f"{resources}/" if three else resources.as_uri()
    return ["3" if three else "2", str(library), description.guid, place]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", default=NAMES)
    parser.add_argument("--before", type=Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        host = f"{folder}/versions"
        source = Path(__file__).with_name("versions.c")
        subprocess.run(["cc", "-O2", "-o", host, str(source), "-ldl", "-lm"], check=True)
        print("| FMU | FMI 2.0, ns | FMI 3.0, ns | ratio |" + (" before, ns | ratio |" if arguments.before else ""))
        print("|---|--:|--:|--:|" + ("--:|--:|" if arguments.before else ""))
        for name in arguments.names:
            paths = [arguments.folder / f"{name}.fmu", arguments.folder / "fmi3" / f"{name}.fmu"]
            paths += [arguments.before / f"{name}.fmu"] if arguments.before else []
            variables = read_model_description(str(paths[0])).modelVariables
            inputs = sum(v.causality == "input" for v in variables)
            # States that are outputs stand among the states.
            outputs = sum(v.causality == "output" and v.initial == "calculated" for v in variables)
            parts = [part for path in paths for part in subject(path)]
            command = [host, str(inputs), str(outputs), *parts]
            told = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
            costs, sums = [float(cost) for cost in told[::2]], told[1::2]
            assert len(set(sums)) == 1, f"{name} goes elsewhere: {sums}"
            row = [name, f"{costs[0]:.0f}", f"{costs[1]:.0f}", f"{costs[1] / costs[0]:.3f}"]
            row += [f"{costs[2]:.0f}", f"{costs[0] / costs[2]:.3f}"] if arguments.before else []
            print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
