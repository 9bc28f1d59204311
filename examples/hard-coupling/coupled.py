"""FMUs that are coupled hard, and what a master can ask them for: steps with inputs that move, slopes of outputs, a
state to come back to, derivatives.

Every connection `j` carries one number `y[j]`, which is an output of one component and an input of another. Within a
step each input is a polynomial of the time since the step's start, given by its derivatives: `path[k, j]` is the k-th
derivative of input `j` (k = 0: the value). FMI 2.0 takes them with `fmi2SetRealInputDerivatives`.
"""

import sys
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from jacobi import System  # noqa: E402


class RunAway(Exception):
    """The connected system has become unstable."""


class Part:
    """A component as the others see it."""

    def __init__(self, component, connections, stimulus, calls):
        self.fmu, self.calls, name = component.fmu, calls, component.name
        of = {f"{name}.{variable.name}": variable.valueReference for variable in component.variables.values()}
        # The connections that it feeds and that feed it.
        self.made = [j for j, (source, _) in enumerate(connections) if source in of]
        self.taken = [j for j, (_, target) in enumerate(connections) if target in of]
        self.outputs = [of[connections[j][0]] for j in self.made]
        self.inputs = [of[connections[j][1]] for j in self.taken]
        self.stimulus = {of[target]: course for target, course in stimulus.items() if target in of}
        rates = [variable for variable in component.variables.values() if variable.derivative is not None]
        self.rates = [rate.valueReference for rate in rates]
        self.states = [rate.derivative.valueReference for rate in rates]
        self.saved = None

    def read(self):
        """The values of its outputs."""
        return self.fmu.getReal(self.outputs)

    def slopes(self):
        """The slopes of its outputs, as its inputs are now."""
        self.calls["slope"] += 1
        return self.fmu.getRealOutputDerivatives(self.outputs, [1] * len(self.outputs))

    def steer(self, time, path):
        """The course of its inputs in the step that starts now; its stimulus is known as it is."""
        if self.inputs:
            self.fmu.setReal(self.inputs, path[0, self.taken])
            for order in range(1, len(path)):
                self.fmu.setRealInputDerivatives(self.inputs, [order] * len(self.inputs), path[order, self.taken])
        for reference, course in self.stimulus.items():
            value, slope = course(time)
            self.fmu.setReal([reference], [value])
            self.fmu.setRealInputDerivatives([reference], [1], [slope])

    def advance(self, time, size, final=True):
        """One step; `final` says that nobody will ask for an earlier state again."""
        self.calls["step"] += 1
        self.fmu.doStep(time, size, noSetFMUStatePriorToCurrentPoint=final)

    def save(self):
        """Keeps its state, in the place of the one before."""
        self.calls["state"] += 1
        if self.saved is not None:
            self.fmu.freeFMUstate(self.saved)
        self.saved = self.fmu.getFMUstate()

    def rewind(self):
        """Back to the state that was kept."""
        self.calls["state"] += 1
        self.fmu.setFMUstate(self.saved)

    def derivatives(self, known):
        """Rates and outputs by the variables `known`, a column each."""
        self.calls["derivative"] += len(known)
        unknown = self.rates + self.outputs
        columns = [self.fmu.getDirectionalDerivative(unknown, [reference], [1.0]) for reference in known]
        matrix = np.array(columns).reshape(len(known), len(unknown)).T
        return matrix[: len(self.rates)], matrix[len(self.rates) :]


class Linear:
    """All components about the present point, side by side, not yet connected.

    With what has changed since the step's start, states `x`, inputs `u` and outputs `y`, and the time `s` since then:
    `x' = rates + a x + b u + moved s`, `y = c x + d u + seen s`, the last terms from the slopes of the stimulus.
    """

    def __init__(self, parts, time, width):
        n = sum(len(part.states) for part in parts)
        self.a, self.b, self.c, self.d = (np.zeros(shape) for shape in ((n, n), (n, width), (width, n), (width, width)))
        self.rates, self.moved, self.seen = np.zeros(n), np.zeros(n), np.zeros(width)
        first = 0
        for part in parts:
            own = slice(first, first := first + len(part.states))
            self.rates[own] = part.fmu.getReal(part.rates)
            self.a[own, own], self.c[part.made, own] = part.derivatives(part.states)
            self.b[own, part.taken], self.d[np.ix_(part.made, part.taken)] = part.derivatives(part.inputs)
            slopes = [course(time)[1] for course in part.stimulus.values()]
            by_stimulus, seen = part.derivatives(list(part.stimulus))
            self.moved[own], self.seen[part.made] = by_stimulus @ slopes, seen @ slopes


class Coupled(System):
    """Components that `method`, one of `methods.py`, takes from step to step.

    `connections` maps pairs of "component.output" and "component.input" to the size that their values have.
    `stimulus` maps "component.input" to a function of time that gives value and slope, which hold to the step's end.
    """

    # What is larger than this, in multiples of the connections' sizes, has run away.
    LIMIT = 1e3

    def __init__(self, folder, components, connections, stimulus, method, parameters=None):
        super().__init__(folder, components, connections, parameters)
        self.scales, self.calls, self.method = np.array(list(connections.values())), Counter(), method
        connections = list(connections)
        self.parts = {
            name: Part(component, connections, stimulus, self.calls) for name, component in self.components.items()
        }

    def initialize(self):
        for part in self.parts.values():
            for reference, course in part.stimulus.items():
                part.fmu.setReal([reference], [course(0.0)[0]])
        super().initialize()

    def gather(self, ask, names=None):
        """A number for each connection that the named components feed (zero for the others)."""
        values = np.zeros(len(self.scales))
        for name in names or self.parts:
            part = self.parts[name]
            if part.made:
                values[part.made] = ask(part)
        return values

    def steer(self, time, path):
        """Inputs go along their paths in the step that starts now."""
        for part in self.parts.values():
            part.steer(time, path)

    def advance(self, time, size, final=True):
        """Every component takes the step."""
        for part in self.parts.values():
            part.advance(time, size, final)

    def each(self, act):
        for part in self.parts.values():
            act(part)

    def linear(self, time):
        """The components about the present point, their inputs as the present outputs have them."""
        return Linear(self.parts.values(), time, len(self.scales))

    def step(self, time, size):
        self.method(self, time, size)
        if not np.all(np.abs(self.gather(Part.read)) < self.LIMIT * self.scales):
            raise RunAway(f"at {time + size:g} s: take a shorter step or another method")
