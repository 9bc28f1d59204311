"""What the matrix runs: every single FMU and every system, as jobs that any master can be told."""

import re
import sys
import zipfile
from pathlib import Path

import numpy as np
from connected import ExchangedAfterwards
from excitation import excitation
from fmpy import read_model_description

sys.path.insert(0, str(Path(__file__).parent.parent.parent / "examples"))
from jacobi import System  # noqa: E402
from ssp import read  # noqa: E402

# A second where only time moves anything: the roads that begin at 0.5 s have reached the rear wheels.
STEP, COUNT, LONG = 1e-3, 200, 1000


# What rests for longer than a job lasts is made to begin.
BEGIN = {"switch_on_time": 0.05}


class Job:
    """Components, connections, start values, and what is looked at, for `count` steps."""

    def __init__(self, name, components, connections, values, signals, step=STEP, count=COUNT):
        self.name, self.components, self.connections = name, components, connections
        self.values, self.signals, self.step, self.count = values, signals, step, count

    def fields(self):
        names = ("components", "connections", "values", "signals", "step", "count")
        return {name: getattr(self, name) for name in names}

    def run(self, kind):
        """In a master of the examples' kind: a row after every step."""
        components = {name: path.removesuffix(".fmu") for name, path in self.components.items()}
        with kind("/", components, self.connections, self.values) as system:
            result = system.run(self.count * self.step, self.step, self.signals)
        return np.array([result[signal][1:] for signal in self.signals]).T


def single(path):
    """An FMU by itself, its inputs held where every effect is at work."""
    variables = read_model_description(str(path)).modelVariables
    inputs = [v for v in variables if v.causality == "input" and v.type == "Real"]
    # As the checks swing them, at a time when none is at zero: each by another amount.
    values = {f"fmu.{v.name}": float(v.start) + excitation(v.name, v.unit, 0.1) for v in inputs}
    values |= {f"fmu.{v.name}": BEGIN[v.name] for v in variables if v.name in BEGIN}
    signals = [f"fmu.{v.name}" for v in variables if v.causality == "output" and v.type == "Real"]
    return Job(path.stem, {"fmu": str(path.resolve())}, [], values, signals, count=COUNT if inputs else LONG)


def system(path, folder):
    """A system with its start values; its FMUs are unpacked to the folder."""
    components, connections, values = read(path)
    with zipfile.ZipFile(path) as archive:
        archive.extractall(folder, [name for name in archive.namelist() if name.endswith(".fmu")])
        # Some masters take the step from the file.
        step = float(re.search(rb'baseStepSize="([^"]+)"', archive.read("SystemStructure.ssd"))[1])
    components = {name: str((Path(folder) / "resources" / f"{fmu}.fmu").resolve()) for name, fmu in components.items()}
    signals = list(dict.fromkeys(source for source, _ in connections))
    return Job(path.stem, components, connections, values, signals, step, LONG)


def off(rows, expected):
    """The largest difference of any signal, relative to the signal's largest value."""
    assert rows.shape == expected.shape, (rows.shape, expected.shape)
    scale = np.abs(expected).max(axis=0)
    assert scale.any(), "nothing moves: nothing is compared"
    return float((np.abs(rows - expected).max(axis=0) / np.where(scale > 0.0, scale, 1.0)).max())


class ZeroAtFirst(System):
    """No exchange before the first step, in which every connected input is zero (FMPy)."""

    def initialize(self):
        self.exchanging = False
        super().initialize()
        for name, inputs in self.inputs.items():
            for variable, _ in inputs:
                self.components[name].set(variable, 0.0)

    def exchange(self):
        if self.exchanging:
            super().exchange()

    def step(self, time, size):
        super().step(time, size)
        self.exchanging = True


class OneTolerance(System):
    """One tolerance for all components."""

    TOLERANCE = 1e-10

    def initialize(self):
        for component in self.components.values():
            if "solver.tolerance" in component.variables:
                component.set("solver.tolerance", self.TOLERANCE)
        super().initialize()


class ContinuousFirst(OneTolerance):
    """Before the first step, connections of continuous variables are exchanged until all agree, and the others then once.
    Later all are exchanged at the end of each step (PyFMI)."""

    step = ExchangedAfterwards.step

    def __init__(self, folder, components, connections, parameters=None):
        super().__init__(folder, components, connections, parameters)
        self.rounds = len(components)
        self.continuous = {
            name: [(variable, source) for variable, source in inputs if self.both_continuous(source, f"{name}.{variable}")]
            for name, inputs in self.inputs.items()
        }

    def both_continuous(self, *ends):
        parts = [end.split(".", 1) for end in ends]
        return all(self.components[name].variables[variable].variability == "continuous" for name, variable in parts)

    def exchange(self):
        self.rounds -= 1
        whole = self.inputs
        if self.rounds > 0:
            self.inputs = self.continuous
        super().exchange()
        self.inputs = whole


class InDependencyOrder(OneTolerance):
    """Before a step, what passes through a component is passed on at once, so that all inputs belong to one instant
    (OMSimulator)."""

    def exchange(self):
        for _ in self.components:
            super().exchange()


class InTurn(ZeroAtFirst):
    """Components that wait for each other take their steps side by side; what they lead to follows with their new
    values (cofmupy)."""

    def __init__(self, folder, components, connections, parameters=None):
        super().__init__(folder, components, connections, parameters)
        names = list(components)
        leads = {name: {t.split(".", 1)[0] for s, t in connections if s.split(".", 1)[0] == name} for name in names}

        def reached(start):
            seen, waiting = set(), [start]
            while waiting:
                for name in leads[waiting.pop()] - seen:
                    seen.add(name)
                    waiting.append(name)
            return seen

        after = {name: reached(name) for name in names}
        groups = {frozenset({name} | {other for other in after[name] if name in after[other]}) for name in names}
        # Who leads to more comes first.
        self.groups = sorted(groups, key=lambda group: -len(set().union(*(after[name] for name in group)) - group))

        self.told = {name: {variable: 0.0 for variable, _ in inputs} for name, inputs in self.inputs.items()}

    def initialize(self):
        self.tell(self.components)
        super().initialize()

    def tell(self, names):
        for name in names:
            for variable, value in self.told[name].items():
                self.components[name].set(variable, value)

    def step(self, time, size):
        for group in self.groups:
            # Not earlier: what is read after the step belongs to the inputs that it was taken with.
            self.tell(group)
            for name in group:
                self.components[name].fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)
            values = self.read({name: self.outputs[name] for name in group})
            for name, inputs in self.inputs.items():
                self.told[name].update({v: values[source] for v, source in inputs if source in values})
