"""What a diagnosis costs, beside a fit that drives the same FMU from Python.

    python examples/benchmark/diagnosis.py fmus/TumQuarterVehicle.fmu

One iteration of a least-squares fit needs the residuals of all signals and their derivatives with respect to every
parameter and every state at the start. Here `scipy.optimize.least_squares` gets them by differences of simulations of
the FMU through FMPy, and the diagnosis by its own integration with derivatives; both in one run on one record: the TUM
rig, five signals, 60 s at 1 kHz. That both have the same information is shown, too. Then a whole diagnosis of that
record, with a second one for validation.
"""

import argparse
import csv
import json
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Slave
from scipy.optimize import least_squares

ROOT = Path(__file__).resolve().parent.parent.parent
RIG = "tum-quarter-vehicle"
INPUTS = ["road.position", "road.velocity", "actuator.force"]
SIGNALS = ["body.acceleration", "wheel.acceleration", "wheel.force", "suspension.deflection", "tire.deflection"]
STATES = ["body.position", "body.velocity", "wheel.position", "wheel.velocity"]
STEP = 1e-3
NOISE = 0.01
# Not in the rig's model: what the whole diagnosis is to find.
HIDDEN = {"strut.orifice.coefficient": 1500.0}


class Rig:
    """The FMU through FMPy: instantiated once, reset for each simulation."""

    def __init__(self, path):
        self.folder = extract(str(path))
        self.description = read_model_description(self.folder)
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self.fmu = FMU2Slave(
            guid=self.description.guid,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            unzipDirectory=self.folder,
            instanceName="rig",
        )
        self.fmu.instantiate()

    def close(self):
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    def references(self, names):
        return [self.variables[name].valueReference for name in names]

    def simulate(self, inputs, start):
        """The signals at the samples, by FMPy's own master, which holds the inputs in between."""
        times = np.arange(len(inputs)) * STEP
        driven = np.array(
            list(zip(times, *inputs.T)), dtype=[("time", float), *((name, float) for name in INPUTS)]
        )
        self.fmu.reset()
        result = simulate_fmu(
            self.folder,
            model_description=self.description,
            fmu_instance=self.fmu,
            stop_time=times[-1],
            output_interval=STEP,
            start_values=start,
            input=driven,
            output=SIGNALS,
        )
        return np.array([result[name] for name in SIGNALS])

    def simulate_by_calls(self, inputs, start):
        """The same with nothing but the calls that it takes; between the samples the inputs go straight."""
        fmu, driven, columns = self.fmu, self.references(INPUTS), self.references(SIGNALS)
        slopes = np.diff(inputs, axis=0) / STEP
        order = [1] * len(driven)
        fmu.reset()
        fmu.setupExperiment(startTime=0.0)
        fmu.setReal(self.references(start), list(start.values()))
        fmu.setReal(driven, list(inputs[0]))
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()
        rows = [fmu.getReal(columns)]
        for index, (row, slope) in enumerate(zip(inputs, slopes)):
            fmu.setReal(driven, row)
            fmu.setRealInputDerivatives(driven, order, slope)
            fmu.doStep(currentCommunicationPoint=index * STEP, communicationStepSize=STEP)
            rows.append(fmu.getReal(columns))
        return np.array(rows).T


def drive(seconds, seed):
    """Road and force: sines of random phase, large slow, small fast."""
    random = np.random.default_rng(seed)
    times = np.arange(round(seconds / STEP)) * STEP

    def sines(amplitude, low, high):
        frequencies = low * 1.2 ** np.arange(np.log(high / low) / np.log(1.2))
        amplitudes = np.sqrt(low / frequencies)
        phases = random.uniform(0.0, 2.0 * np.pi, len(frequencies))
        whole = np.sin(2.0 * np.pi * np.outer(times, frequencies) + phases) @ amplitudes
        return amplitude * whole / np.linalg.norm(amplitudes) * np.minimum(times / 0.5, 1.0) ** 2

    road = sines(6e-3, 0.3, 15.0)
    return times, np.array([road, np.gradient(road, STEP), sines(100.0, 0.5, 18.0)]).T


def record(rig, path, seconds, seed, start):
    """A record as CSV, with noise; the inputs and signals in it."""
    times, inputs = drive(seconds, seed)
    signals = rig.simulate_by_calls(inputs, start)
    random = np.random.default_rng(seed + 1000)
    signals = signals + NOISE * signals.std(axis=1, keepdims=True) * random.standard_normal(signals.shape)
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        names = [INPUTS[0], INPUTS[2], *SIGNALS]
        writer.writerow(["time [s]", *(f"{name} [{rig.variables[name].unit}]" for name in names)])
        columns = [times, inputs[:, 0], inputs[:, 2], *signals]
        writer.writerows([f"{value:.9g}" for value in row] for row in zip(*columns))
    return inputs, signals


def by_scipy(rig, simulate, inputs, measured, parameters):
    """One iteration of least_squares: its time, its simulations, and the information on each parameter."""
    values = np.array([float(rig.variables[name].start) for name in parameters] + [0.0] * len(STATES))
    scales = np.array([max(abs(value), 1.0) for value in values[: len(parameters)]] + [1e-2] * len(STATES))
    simulations = 0

    def residuals(scaled):
        nonlocal simulations
        simulations += 1
        start = dict(zip([*parameters, *STATES], map(float, scaled * scales)))
        return (measured - simulate(inputs, start)).ravel()

    clock = time.perf_counter()
    fit = least_squares(residuals, values / scales, jac="2-point", diff_step=1e-5, max_nfev=1)
    seconds = time.perf_counter() - clock
    jacobian = fit.jac / scales
    whole = jacobian.T @ jacobian
    n = len(parameters)
    reduced = whole[:n, :n] - whole[:n, n:] @ np.linalg.solve(whole[n:, n:], whole[n:, :n])
    return seconds, simulations, np.diag(reduced)


def cargo(*arguments):
    return run("cargo", "run", "--quiet", "--release", "--package", "strut-diagnosis", *arguments)


def run(*command):
    result = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
    if result.returncode:
        raise SystemExit(f"{' '.join(map(str, command))} failed ({result.returncode})\n{result.stderr}")
    return result.stdout


def whole_diagnosis(train, test, out):
    """Time of a diagnosis without building the extended FMU, and its verdict."""
    records = ["--train", train, "--test", test]
    cargo("--bin", "diagnose", "--", "--rig", RIG, *records, "--out", out, "--no-fmu")
    report = json.loads((out / "report.json").read_text(encoding="utf-8"))
    return report["seconds"], report["summary"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmu", type=Path, help="TumQuarterVehicle.fmu")
    parser.add_argument("--seconds", type=float, default=60.0, help="length of the record")
    parser.add_argument("--linearise", type=Path, help="that example, compiled already (default: cargo compiles it)")
    parser.add_argument("--only-iteration", action="store_true", help="without a whole diagnosis")
    options = parser.parse_args()
    rig = Rig(options.fmu)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        inputs, measured = record(rig, scratch / "train.csv", options.seconds, 1, {})
        task = [RIG, scratch / "train.csv"]
        told = run(options.linearise, *task) if options.linearise else cargo("--example", "linearise", "--", *task)
        ours = json.loads(told)
        assert ours["signals"] == SIGNALS, ours["signals"]
        print(f"{len(SIGNALS)} signals of {ours['samples']} samples; {len(ours['parameters'])} parameters and "
              f"{len(STATES)} states at the start\n")
        print("| one iteration | s | ratio | information differs by |\n|---|--:|--:|--:|")
        print(f"| the diagnosis | {ours['seconds']:.3f} | 1 | – |")
        for name, simulate in [("simulate_fmu", rig.simulate), ("bare calls", rig.simulate_by_calls)]:
            seconds, simulations, information = by_scipy(rig, simulate, inputs, measured, ours["parameters"])
            apart = np.max(np.abs(np.array(ours["information"]) / information - 1.0))
            print(f"| least_squares, {simulations} simulations by FMPy's {name} | {seconds:.1f} "
                  f"| {seconds / ours['seconds']:.0f} | {apart:.0e} |", flush=True)
        if not options.only_iteration:
            for name, seed in [("train.csv", 1), ("test.csv", 2)]:
                record(rig, scratch / name, options.seconds, seed, HIDDEN)
            records = [scratch / name for name in ("train.csv", "test.csv")]
            seconds, summary = whole_diagnosis(*records, scratch / "report")
            print(f"\na whole diagnosis takes {seconds:.0f} s: {summary}")
    rig.close()


if __name__ == "__main__":
    main()
