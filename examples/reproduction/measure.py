"""How numbers are read off FMUs: calculated parameters, linearisations, sines, densities."""

import math
import shutil
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Model
from jacobi import Component


def parameters(fmus, name, start=None):
    """The numbers of an initialised FMU."""
    component = Component(name, Path(fmus) / f"{name}.fmu")
    for variable, value in (start or {}).items():
        component.set(variable, value)
    component.fmu.setupExperiment(startTime=0.0)
    component.fmu.enterInitializationMode()
    component.fmu.exitInitializationMode()
    found = {}
    for kind, read in {"Real": component.fmu.getReal, "Integer": component.fmu.getInteger}.items():
        names = [variable.name for variable in component.variables.values() if variable.type == kind]
        found.update(zip(names, read(component.references(names)), strict=True))
    component.close(failed=False)
    return found


def stepped(fmus, name, output, inputs, seconds, size=1e-3, start=None):
    """An output after each step. Inputs are numbers, or functions of the time at which a step begins."""
    component = Component(name, Path(fmus) / f"{name}.fmu")
    for variable, value in (start or {}).items():
        component.set(variable, value)
    component.fmu.setupExperiment(startTime=0.0)
    component.fmu.enterInitializationMode()
    component.fmu.exitInitializationMode()
    driven, read = component.references(inputs), component.references([output])
    values = []
    for index in range(round(seconds / size)):
        time = index * size
        component.fmu.setReal(driven, [value(time) if callable(value) else value for value in inputs.values()])
        component.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)
        values.append(component.fmu.getReal(read)[0])
    component.close(failed=False)
    return np.array(values)


@dataclass
class Linear:
    """x' = A x + B u, y = C x + D u, around where the FMU starts."""

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray
    states: list

    def response(self, frequencies):
        """Complex gain at each frequency in Hz: outputs × inputs."""
        eye = np.eye(len(self.a))
        return np.array([self.c @ np.linalg.solve(math.tau * 1j * f * eye - self.a, self.b) + self.d for f in frequencies])

    def modes(self):
        """Natural frequency in Hz and damping ratio of each eigenvalue, the slowest first; states that rest have none."""
        values = sorted(np.linalg.eigvals(self.a), key=abs)
        return [(abs(value) / math.tau, -value.real / abs(value)) for value in values if abs(value) > 1e-9]


@contextmanager
def exchanged(fmus, name, start=None):
    """An FMU as a model for exchange, initialised; with its description."""
    folder = extract(str(Path(fmus) / f"{name}.fmu"))
    description = read_model_description(folder)
    variables = {variable.name: variable for variable in description.modelVariables}
    fmu = FMU2Model(
        guid=description.guid,
        modelIdentifier=description.modelExchange.modelIdentifier,
        unzipDirectory=folder,
        instanceName=name,
    )
    fmu.instantiate()
    try:
        for variable, value in (start or {}).items():
            kind = "Integer" if variables[variable].type == "Enumeration" else variables[variable].type
            getattr(fmu, f"set{kind}")([variables[variable].valueReference], [value])
        fmu.setupExperiment(startTime=0.0)
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()
        fmu.enterContinuousTimeMode()
        yield fmu, description, variables
        fmu.terminate()
    finally:
        fmu.freeInstance()
        shutil.rmtree(folder, ignore_errors=True)


def linearise(fmus, name, inputs=(), outputs=(), start=None):
    """The linearisation by the FMU's exact directional derivatives."""
    with exchanged(fmus, name, start) as (fmu, description, variables):
        rates = [entry.variable for entry in description.derivatives]
        states = [rate.derivative for rate in rates]
        references = [variable.valueReference for variable in rates]
        references += [variables[output].valueReference for output in outputs]
        along = [state.valueReference for state in states] + [variables[name].valueReference for name in inputs]
        jacobian = np.array([fmu.getDirectionalDerivative(references, [known], [1.0]) for known in along]).T
        n = len(states)
        return Linear(
            a=jacobian[:n, :n],
            b=jacobian[:n, n:],
            c=jacobian[n:, :n],
            d=jacobian[n:, n:],
            states=[state.name for state in states],
        )


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))
