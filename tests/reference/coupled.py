"""Connected components as one ODE, sampled controllers handled exactly.

A controller reads the state at t_k and its command acts until its next tick. Between two ticks all continuous
components are one system: nothing is exchanged, so there is no coupling error. A row at t_k is read after the tick,
with the roads' values from the right.
"""

import math

from integrate import Smooth, advance


class System(Smooth):
    """Continuous components, driven by what roads and controllers put out (the inputs u of the whole).

    `order` names the components in the order in which their outputs can be had: one whose outputs need another's
    may be named twice, first for those that follow from its states alone.
    """

    def __init__(self, components, connections, order):
        self.components, self.sources = components, dict((target, source) for source, target in connections)
        self.roads = [name for name, part in components.items() if hasattr(part, "breaks")]
        self.sampled = [name for name, part in components.items() if getattr(part, "period", None)]
        driving = [f"{name}.{output}" for name in self.roads + self.sampled for output in components[name].outputs]
        self.parts = [name for name in components if name not in self.roads + self.sampled]
        self.slices, first = {}, 0
        for name in self.parts:
            self.slices[name] = slice(first, first + len(components[name].states))
            first += len(components[name].states)
        self.size = first
        self.max_step = min(components[name].max_step for name in self.parts)
        self.names = driving + [f"{name}.{column}" for name in self.parts
                                for column in components[name].states + components[name].outputs]
        position = {name: index for index, name in enumerate(self.names)}
        # The inputs of each component as positions in the values of all signals.
        self.wiring = {name: [position.get(self.sources.get(f"{name}.{target}")) for target in part.inputs]
                       for name, part in components.items() if name not in self.roads}
        self.driving, self.position = len(driving), position
        self.sweeps = [(name, components[name], self.slices[name], self.wiring[name],
                        self.driving + sum(len(components[n].states + components[n].outputs)
                                           for n in self.parts[:self.parts.index(name)])) for name in order]

    @staticmethod
    def gather(values, wiring):
        return [0.0 if index is None else values[index] for index in wiring]

    def sweep(self, x, u, modes=None):
        """The values of all signals, and the inputs and the mode of each component."""
        values = list(u) + [0.0] * (len(self.names) - self.driving)
        inputs, found = {}, {}
        for name, part, states, wiring, first in self.sweeps:
            own, given = x[states], self.gather(values, wiring)
            mode = modes[name] if modes else part.mode(own, given)
            row = [*own, *part.output(own, given, mode)]
            values[first:first + len(row)] = row
            inputs[name], found[name] = given, mode
        return values, inputs, found

    def mode(self, x, u):
        return self.sweep(list(x), u)[2]

    def derivative(self, x, u, modes):
        x = list(x)
        _, inputs, _ = self.sweep(x, u, modes)
        return [rate for name in self.parts for rate in
                self.components[name].derivative(x[self.slices[name]], inputs[name], modes[name])]

    def guards(self, x, u):
        x = list(x)
        _, inputs, _ = self.sweep(x, u)
        return [guard for name in self.parts for guard in
                self.components[name].guards(x[self.slices[name]], inputs[name])]

    def watched(self, modes):
        found, first = [], 0
        for name in self.parts:
            part = self.components[name]
            found += [(first + index, direction) for index, direction in part.watched(modes[name])]
            first += part.guard_count
        return found

    def after(self, modes, guard, x, u):
        x = list(x)
        _, inputs, _ = self.sweep(x, u, modes)
        for name in self.parts:
            part = self.components[name]
            if guard < part.guard_count:
                return modes | {name: part.after(modes[name], guard, x[self.slices[name]], inputs[name])}
            guard -= part.guard_count
        raise IndexError(guard)

    def settle(self, x, modes):
        x = list(x)
        return [value for name in self.parts
                for value in self.components[name].settle(x[self.slices[name]], modes[name])]

    def held(self, memory):
        """What the sampled components put out; zero before their first tick."""
        return [value for name in self.sampled for part in [self.components[name]]
                for value in (part.output([], [0.0] * len(part.inputs) + memory[name], ()) if memory[name]
                              else [0.0] * len(part.outputs))]

    def begin(self, start):
        known = [f"{name}.{state}" for name in self.parts for state in self.components[name].states]
        assert set(start) <= set(known), start
        return [start.get(state, 0.0) for state in known]

    def run(self, stop, step, every, solver, start=None, longest=10):
        """Rows (time and the values of all signals) every so many steps, and how often there was which mode.

        `start` are values of states other than zero. Where nothing is sampled and no row is due, up to `longest` steps
        are one piece.
        """
        x, count = self.begin(start or {}), round(stop / step)
        stride = math.gcd(longest, every, *(round(self.components[name].period / step) for name in self.sampled))
        marks = sorted({mark for name in self.roads for mark in self.components[name].breaks(stop)})
        memory = {name: None for name in self.sampled}
        rows, modes = [], {}
        for k in range(0, count + 1, stride):
            t0, t1 = k * step, (k + stride) * step
            at_tick = [value for name in self.roads for value in self.components[name](t0, t0 + 1e-9)]
            values, _, mode = self.sweep(x, at_tick + self.held(memory))
            for name in self.sampled:
                part = self.components[name]
                if k % round(part.period / step) == 0:
                    given = self.gather(values, self.wiring[name])
                    memory[name] = part.tick(memory[name], [], given, k // round(part.period / step))
            held = self.held(memory)
            for name, found in mode.items():
                if found not in ((), "contact"):
                    modes[f"{name} {found}"] = modes.get(f"{name} {found}", 0) + 1
            if k % every == 0:
                rows.append([t0, *self.sweep(x, at_tick + held)[0]])
            if k == count:
                return rows, modes
            # A piece shorter than 1 ns is the rounding of a mark that lies on the grid.
            ends = [t0] + [m for m in marks if t0 + 1e-9 < m < t1 - 1e-9] + [t1]
            for a, b in zip(ends, ends[1:]):
                roads = [self.components[name].piece(a, b) for name in self.roads]
                x = advance(self, a, b, x, lambda t: [value for road in roads for value in road(t)] + held, solver)
        raise AssertionError("unreachable")
