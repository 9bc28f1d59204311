"""How long does a co-simulation step take, beside other people's FMUs?

    python benchmark.py OURS.fmu [--peer THEIRS.fmu ...] [--runs 7]

Each FMU is driven by the same small C host (host.c, error control at 1e-6) in turn, A B A B ..., so that a
machine whose speed drifts does not decide. Printed are the median time of a step and its ratio to each peer's,
run by run. An FMU that decays should not be followed until its numbers are denormal: those are slow (--steps).
Inputs whose unit is known move as on a rough road, the first output is read, the step is that of the FMU's
default experiment unless given.
Needs Python 3 and a C compiler, nothing else. Linux and macOS.
"""

import argparse
import statistics
import subprocess
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

AMPLITUDE = {"m": 0.01, "m/s": 0.13, "N": 200.0, "V": 2.0}


def command(host, fmu, folder, step, steps):
    """The host's command line for an FMU, unpacked into a folder."""
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    root = ElementTree.parse(folder / "modelDescription.xml").getroot()
    slave = root.find("CoSimulation")
    if slave is None:
        raise SystemExit(f"{fmu}: it has no co-simulation side")
    library = next(folder.glob(f"binaries/*64/{slave.get('modelIdentifier')}.*"))
    variables = [v for v in root.findall("ModelVariables/ScalarVariable") if v.find("Real") is not None]
    inputs = [
        f"{v.get('valueReference')}={AMPLITUDE[v[0].get('unit')]}"
        for v in variables
        if v.get("causality") == "input" and v[0].get("unit") in AMPLITUDE
    ]
    outputs = [v.get("valueReference") for v in variables if v.get("causality") == "output"]
    output = (outputs or [variables[0].get("valueReference")])[0]
    experiment = root.find("DefaultExperiment")
    size = step or float(experiment.get("stepSize", 1e-3) if experiment is not None else 1e-3)
    resources = (folder / "resources").as_uri()
    return [str(host), str(library), root.get("guid"), resources, str(size), str(steps), output, *inputs]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmus", nargs="+", type=Path)
    parser.add_argument("--peer", action="append", default=[], type=Path)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--steps", type=int, default=200_000)
    parser.add_argument("--step", type=float, help="communication step in seconds, for all")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        host = scratch / "host"
        source = Path(__file__).with_name("host.c")
        subprocess.run(["cc", "-O2", "-o", str(host), str(source), "-ldl", "-lm"], check=True)
        everything = [*options.fmus, *options.peer]
        commands = [command(host, fmu, scratch / str(i), options.step, options.steps) for i, fmu in enumerate(everything)]
        times = [[] for _ in everything]
        for _ in range(options.runs):
            for place, arguments in enumerate(commands):
                output = subprocess.run(arguments, check=True, capture_output=True, text=True).stdout
                times[place].append(float(output.split()[0]))
    peers = range(len(options.fmus), len(everything))
    heading = "".join(f"{'/ ' + everything[peer].stem:>24}" for peer in peers)
    print(f"{'FMU':32}{'ns a step':>12}{heading}")
    for place, fmu in enumerate(everything):
        ratios = [statistics.median(a / b for a, b in zip(times[place], times[peer])) for peer in peers]
        print(f"{fmu.stem:32}{statistics.median(times[place]):12.1f}" + "".join(f"{ratio:24.2f}" for ratio in ratios))


if __name__ == "__main__":
    main()
