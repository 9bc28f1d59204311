"""Model exchange with moving inputs: every FMU in importers that integrate it, against its co-simulation.

    python model_exchange.py FOLDER [--short] [--page FILE] [--pyfmi PYTHON]

Inputs go in straight lines between samples of 1 ms. The reference is co-simulation with their slopes (fmi2SetRealInputDerivatives)
at a tolerance of 1e-10: the same inputs, to the last digit. A cell is the largest difference of any output at the samples,
relative to its largest value.
"""

import argparse
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu
from model_exchange_importers import Casadi, PyFmi, Scipy
from recorded import before_events
from rig import STEP, Fmu

sys.path.insert(0, str(Path(__file__).parents[2] / "examples"))
from fmpy_inputs import with_inputs

COUNT = 200

# scipy and CasADi set the inputs whenever they ask for rates; what is left is their tolerance.
EXACT = 1e-6
# FMPy 0.3.32 sets inputs only where it asks for event indicators, once in each internal step: an error of first order.
HELD = 5e-3
# With the inputs in the rates: what its CVode makes of a relative tolerance of 1e-8.
INTEGRATED = 1e-4
# What its CVode gives up, since such inputs jump from step to step: more than 500 internal steps in a tenth of a millisecond.
GIVEN_UP = {"ExcitationMotor", "TumExcitationMotor"}

# A rig with friction, an actuator, one that FMPy gives up, a source.
SHORT = {"TumQuarterVehicle", "KoniecznyServoHydraulicActuator", "ExcitationMotor", "VoltageSource"}


class Job:
    """Moving inputs, and what co-simulation makes of them."""

    def __init__(self, fmu):
        self.fmu = fmu
        self.times = STEP * np.arange(COUNT + 1)
        self.inputs = np.array([fmu.excitation(time) for time in self.times]).reshape(COUNT + 1, len(fmu.inputs))
        # What changes at ticks only belongs to the tick that has just been: importers differ in which side they show.
        self.outputs = [v for v in fmu.outputs if v.variability == "continuous"]

    def at(self, time):
        """The inputs at a time."""
        index = min(int(time / STEP), COUNT - 1)
        share = time / STEP - index
        return (1.0 - share) * self.inputs[index] + share * self.inputs[index + 1]

    def co_simulated(self):
        references = [v.valueReference for v in self.fmu.inputs]
        rows = []
        with self.fmu.running(tolerance=1e-10) as slave:
            for index in range(COUNT):
                if references:
                    slopes = (self.inputs[index + 1] - self.inputs[index]) / STEP
                    slave.setReal(references, self.inputs[index])
                    slave.setRealInputDerivatives(references, [1] * len(references), slopes)
                slave.doStep(currentCommunicationPoint=index * STEP, communicationStepSize=STEP)
                rows.append(slave.getReal([v.valueReference for v in self.outputs]))
        return np.array(rows)


class Fmpy:
    """FMPy's own simulation."""

    name, tolerance = "FMPy", HELD

    def cannot(self, job):
        return "gives up" if job.fmu.path.stem in GIVEN_UP else None

    def run(self, job):
        table = np.zeros(COUNT + 1, dtype=[("time", float)] + [(v.name, float) for v in job.fmu.inputs])
        table["time"] = job.times
        for place, variable in enumerate(job.fmu.inputs):
            table[variable.name] = job.inputs[:, place]
        # Its CVode has 500 internal steps from output to output.
        names = [v.name for v in job.outputs]
        options = {"relative_tolerance": 1e-8, "output": names, "output_interval": STEP / 10, "stop_time": COUNT * STEP}
        result = self.simulated(job, table if job.fmu.inputs else None, options)
        return before_events(result, names, job.times[1:])

    def simulated(self, job, table, options):
        return simulate_fmu(str(job.fmu.path), fmi_type="ModelExchange", input=table, **options)


class FmpyWithInputs(Fmpy):
    """FMPy unchanged, with an instance that sets its inputs with each new time. The remaining error is the FMU's."""

    name, tolerance = "FMPy, inputs with the time", INTEGRATED

    def cannot(self, job):
        return None

    def simulated(self, job, table, options):
        if table is None:
            return super().simulated(job, table, options)
        arguments = with_inputs(job.fmu.folder, table)
        try:
            return simulate_fmu(**arguments, **options)
        finally:
            arguments["fmu_instance"].freeInstance()


IMPORTERS = [Scipy(EXACT), Casadi(EXACT), Fmpy(), FmpyWithInputs()]


def importers(pyfmi):
    """All importers; PyFMI where a Python is named that has it."""
    return IMPORTERS + ([PyFmi(INTEGRATED, pyfmi, fmi) for fmi in (2, 3)] if pyfmi else [])


def off(rows, expected):
    """The largest difference, relative to each output's largest value."""
    assert rows.shape == expected.shape, (rows.shape, expected.shape)
    scale = np.abs(expected).max(axis=0)
    return float((np.abs(rows - expected).max(axis=0) / np.where(scale > 0.0, scale, 1.0)).max())


def written(cell):
    return cell if isinstance(cell, str) else "0" if cell == 0.0 else f"{cell:.0e}".replace("e-0", "e−").replace("e-", "e−")


HEAD = """\
# Model exchange with moving inputs

Made by

```
scripts/long-tests model-exchange
```

Inputs go in straight lines between samples of 1 ms, for 200 ms. The reference is co-simulation with the slopes of the inputs
(`fmi2SetRealInputDerivatives`), at a tolerance of 1e-10. **A number** is the largest difference of any output at the samples,
relative to the output's largest value. `cargo test` runs some of each kind.

| importer | version | how it sets inputs | tolerance |
|---|---|---|--:|
| scipy | {scipy} | whenever it asks for rates; starts anew where an event indicator changes its sign | 1e−6 |
| CasADi | {casadi} | the same, with exact Jacobians; no time events, and so no FMUs that sample | 1e−6 |
| FMPy | {FMPy} | once in each internal step of CVODE, where it asks for event indicators | 5e−3 |
| FMPy, inputs with the time | {FMPy} | whenever CVODE asks for rates: the same FMPy is given an instance that sets its inputs with its time ([`with_inputs`](../../examples/fmpy_inputs.py)) | 1e−4 |

**What FMPy leaves alone is FMPy's.** Its right-hand side (`CVodeSolver.f`) sets time and states, but no inputs: they are those of
the last internal step. The error is of first order in that step. It falls with the relative tolerance (here 1e-8; at 1e-5 it is up
to 0.1). An exciter's inputs jump from step to step, and CVODE wants more than 500 steps in a tenth of a millisecond. FMPy takes an
instance of yours (`fmu_instance`). If that sets its inputs with its time, every FMU is within 1e-4 of co-simulation, and no exciter
is given up.

**PyFMI** has to be built. [Its results](README.md#pyfmi) are there.

"""


def page(path, rows, used):
    """Writes the table."""
    names = [importer.name for importer in used]
    text = HEAD.format(**{name: version(name.lower()) for name in ("scipy", "casadi")}, FMPy=version("FMPy"))
    text += "| FMU | " + " | ".join(names) + " |\n|---|" + "--:|" * len(names) + "\n"
    for fmu, row in rows.items():
        text += f"| {fmu} | " + " | ".join(written(row[name]) for name in names) + " |\n"
    path.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--short", action="store_true", help="some of each kind, not all")
    parser.add_argument("--page", type=Path, help="file to write the table to")
    parser.add_argument("--pyfmi", metavar="PYTHON", help="a Python that has PyFMI")
    arguments = parser.parse_args()
    used = importers(arguments.pyfmi)
    failures, rows = [], {}
    for path in sorted(arguments.folder.glob("*.fmu")):
        if arguments.short and path.stem not in SHORT:
            continue
        fmu = Fmu(path)
        job = Job(fmu)
        if not job.outputs:
            continue
        expected, row = job.co_simulated(), {}
        for importer in used:
            reason = importer.cannot(job)
            if reason:
                row[importer.name] = reason
                continue
            try:
                row[importer.name] = apart = off(importer.run(job), expected)
            except Exception as error:
                failures.append(f"{importer.name}, {path.stem}: {error}")
                continue
            if not apart <= importer.tolerance:
                failures.append(f"{importer.name}, {path.stem}: {apart:.1e} apart")
        fmu.close()
        rows[path.stem] = row
        print(path.stem, *(f"{name}: {written(cell)}" for name, cell in row.items()), flush=True)
    if failures:
        sys.exit("\n".join(failures))
    for importer in used:
        assert any(isinstance(row[importer.name], float) for row in rows.values()), f"nothing ran in {importer.name}"
    if arguments.page:
        page(arguments.page, rows, used)


if __name__ == "__main__":
    main()
