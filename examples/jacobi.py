"""A co-simulation master that fits on a page: components, connections, one loop.

At every communication point all outputs are read, then all inputs are set, then every component takes
the same step with its inputs held. Nobody waits for anybody else's new values: that is a Jacobi master.
What it costs is a delay of one step in each connection, so the error is proportional to the step.
"""

import shutil
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave


class Component:
    """One FMU: unpacked, its description read, one instance of it made."""

    def __init__(self, name, path):
        self.name = name
        self.folder = extract(str(path))
        description = read_model_description(self.folder)
        self.variables = {variable.name: variable for variable in description.modelVariables}
        self.fmu = FMU2Slave(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=self.folder,
            instanceName=name,
        )
        self.fmu.instantiate()

    def references(self, names):
        return [self.variables[name].valueReference for name in names]

    def set(self, name, value):
        """Sets a variable of any type; an enumeration's item by its number."""
        variable = self.variables[name]
        kind = "Integer" if variable.type == "Enumeration" else variable.type
        getattr(self.fmu, f"set{kind}")([variable.valueReference], [value])

    def close(self, failed):
        # After an error the standard allows nothing but to free the instance.
        if not failed:
            self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


class System:
    """Components with their connections, to be used in a `with` block.

    `components` maps names to FMUs in `folder`. `connections` are pairs of "component.output" and
    "component.input". `parameters` maps "component.parameter" to a value other than the FMU's own.
    """

    def __init__(self, folder, components, connections, parameters=None):
        self.components = {name: Component(name, Path(folder) / f"{fmu}.fmu") for name, fmu in components.items()}
        # By component, so that each is asked once and told once in every exchange.
        self.outputs = {name: [] for name in components}
        self.inputs = {name: [] for name in components}
        for source, target in connections:
            self.add(self.outputs, source)
            name, variable = target.split(".", 1)
            self.inputs[name].append((variable, source))
        for target, value in (parameters or {}).items():
            name, variable = target.split(".", 1)
            self.components[name].set(variable, value)

    @staticmethod
    def add(signals, signal):
        name, variable = signal.split(".", 1)
        if variable not in signals[name]:
            signals[name].append(variable)

    def __enter__(self):
        return self

    def __exit__(self, exception, *_):
        for component in self.components.values():
            component.close(failed=exception is not None)

    def read(self, signals):
        """The values of "component.variable" signals, given as {component: [variable, …]}."""
        values = {}
        for name, variables in signals.items():
            if variables:
                component = self.components[name]
                read = component.fmu.getReal(component.references(variables))
                values.update((f"{name}.{variable}", value) for variable, value in zip(variables, read, strict=True))
        return values

    def exchange(self):
        """Outputs to inputs: all are read before any is set."""
        values = self.read(self.outputs)
        for name, inputs in self.inputs.items():
            if inputs:
                component = self.components[name]
                references = component.references([variable for variable, _ in inputs])
                component.fmu.setReal(references, [values[source] for _, source in inputs])

    def initialize(self):
        for component in self.components.values():
            component.fmu.setupExperiment(startTime=0.0)
            component.fmu.enterInitializationMode()
        # A value that passes through a component arrives only in the next exchange.
        for _ in self.components:
            self.exchange()
        for component in self.components.values():
            component.fmu.exitInitializationMode()

    def step(self, time, size):
        self.exchange()
        for component in self.components.values():
            component.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)

    def run(self, stop, size, signals, every=1):
        """Simulates from 0 to `stop`; returns {"time": …, signal: …} with a row every so many steps.

        A row is read at the end of the step that arrives there, before the next exchange.
        """
        recorded = {name: [] for name in self.components}
        for signal in signals:
            self.add(recorded, signal)
        self.initialize()
        times, rows = [0.0], [self.read(recorded)]
        for index in range(round(stop / size)):
            # Not added up: after many steps a sum of steps is no longer a multiple of the step.
            self.step(index * size, size)
            if (index + 1) % every == 0:
                times.append((index + 1) * size)
                rows.append(self.read(recorded))
        return {"time": np.array(times)} | {signal: np.array([row[signal] for row in rows]) for signal in signals}
