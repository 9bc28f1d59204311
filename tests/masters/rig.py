"""An FMU on the test bench: loaded through FMPy, driven by reproducible inputs."""

import contextlib
import shutil
from pathlib import Path

import numpy as np
from excitation import excitation
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

STEP = 1e-3


class Messages(list):
    """What an FMU has logged."""

    def callbacks(self):
        """The callbacks of an instance that logs here; without memory functions, which are not needed."""
        self.logger = fmi2CallbackLoggerTYPE(self.log)
        self.structure = fmi2CallbackFunctions(logger=self.logger)
        return self.structure

    def log(self, _environment, instance, status, category, message):
        assert category, "a null log category crashes some masters"
        self.append((instance.decode(), status, category.decode(), message.decode()))


class Fmu:
    """An unpacked FMU with its description."""

    def __init__(self, path):
        self.path = Path(path)
        self.name = self.path.stem
        self.folder = extract(str(path))
        self.description = read_model_description(self.folder)
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.real = [v for v in self.description.modelVariables if v.type == "Real"]
        self.inputs = [v for v in self.real if v.causality == "input"]
        # What the inputs swing about: an eccentric is not at height zero.
        self.middle = [float(v.start) for v in self.inputs]
        self.outputs = [v for v in self.real if v.causality == "output"]
        self.states = [d.variable.derivative for d in self.description.derivatives]
        self.rates = [d.variable for d in self.description.derivatives]

    def close(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def reference(self, *names):
        return [self.variables[name].valueReference for name in names]

    def unborn(self, kind=FMU2Slave, name="instance"):
        """The loaded library, before there is an instance."""
        interface = self.description.coSimulation if kind is FMU2Slave else self.description.modelExchange
        return kind(
            guid=self.description.guid,
            modelIdentifier=interface.modelIdentifier,
            unzipDirectory=self.folder,
            instanceName=name,
        )

    def instantiate(self, kind=FMU2Slave, name="instance", **options):
        fmu = self.unborn(kind, name)
        fmu.instantiate(**options)
        return fmu

    @contextlib.contextmanager
    def running(self, kind=FMU2Slave, start=None, stop=None, tolerance=None, **options):
        """An initialised instance."""
        fmu = self.instantiate(kind, **options)
        try:
            self.initialize(fmu, start, stop, tolerance)
            yield fmu
            fmu.terminate()
        finally:
            fmu.freeInstance()

    def initialize(self, fmu, start=None, stop=None, tolerance=None):
        fmu.setupExperiment(startTime=0.0, stopTime=stop, tolerance=tolerance)
        for name, value in (start or {}).items():
            self.set(fmu, name, value)
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()

    def set(self, fmu, name, value):
        variable = self.variables[name]
        setter = {
            "Real": fmu.setReal,
            "Integer": fmu.setInteger,
            "Enumeration": fmu.setInteger,
            "Boolean": fmu.setBoolean,
            "String": fmu.setString,
        }[variable.type]
        setter([variable.valueReference], [value])

    def excitation(self, time):
        """Inputs at a time."""
        swings = [excitation(variable.name, variable.unit, time) for variable in self.inputs]
        return [middle + swing for middle, swing in zip(self.middle, swings)]

    def excite(self, fmu, time):
        if self.inputs:
            fmu.setReal([v.valueReference for v in self.inputs], self.excitation(time))

    def read(self, fmu):
        return fmu.getReal([v.valueReference for v in self.outputs])

    def run(self, fmu, first, count, step=STEP):
        """Takes steps with the excitation; the outputs after each."""
        rows = []
        for index in range(first, first + count):
            time = index * step
            self.excite(fmu, time)
            fmu.doStep(currentCommunicationPoint=time, communicationStepSize=step)
            rows.append(self.read(fmu))
        return np.array(rows)


def all_fmus(folder):
    paths = sorted(Path(folder).glob("*.fmu"))
    assert paths, f"no FMUs in {folder}"
    return [Fmu(path) for path in paths]
