"""What the generators in this folder share: excitation, solver, noise, CSV, and a comparison with the FMU.

A generator is a module with

    FMU       the file, to be put into this folder
    NOMINAL   the FMU's parameters (of its model description)
    TRUE      those of the record, off by a few per cent
    HIDDEN    what is hidden in the record, by name and size; {} for nothing
    STEP, DURATION
    MEASURED  columns with noise: {name: unit}
    inputs(seed, time) -> {(name, unit): values}
    respond(p, hidden, time, u) -> {name: values}, u the inputs by their names
    EVENTS    True where the FMU has events that matter to --agree

    python NAME.py FOLDER             writes NAME-train.csv and NAME-test.csv
    python NAME.py --agree            compares with the FMU where nothing is hidden (needs FMPy)

Nothing of Strut or of the FMU is in the records: the equations are in each module and solved by scipy.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

HERE = Path(__file__).resolve().parent
# Noise of a sensor in parts of its standard deviation.
NOISE = 0.005


def multisine(seed, time, low, high, rms, tilt=0.0):
    """Sines from `low` to `high` Hz with random phases, amplitudes falling with frequency to the power of `tilt`."""
    random = np.random.default_rng(seed)
    spacing = max(1.0 / (time[-1] - time[0]), (high - low) / 150.0)
    frequencies = np.arange(low, high, spacing)
    phases = random.uniform(0.0, 2.0 * np.pi, len(frequencies))
    y = (frequencies[:, None] ** -tilt * np.sin(2.0 * np.pi * frequencies[:, None] * time + phases[:, None])).sum(0)
    return rms * y / np.std(y)


def drive(time, values):
    """A recorded input as a function of time."""
    return CubicSpline(time, values)


def solve(rate, start, time, max_step=None, method="RK45"):
    """States at the times of the record."""
    max_step = max_step or 2.0 * (time[1] - time[0])
    solved = solve_ivp(rate, (time[0], time[-1]), start, method, t_eval=time, rtol=1e-8, atol=1e-10, max_step=max_step)
    assert solved.success, solved.message
    return solved.y


def lagged(time, y, constant):
    """A first-order lag, at rest in the beginning."""
    y = drive(time, y)
    return solve(lambda t, x: [(y(t) - x[0]) / constant], [y(time[0])], time)[0]


def record(module, seed):
    time = np.arange(0.0, module.DURATION, module.STEP)
    inputs = module.inputs(seed, time)
    u = {name: values for (name, _), values in inputs.items()}
    outputs = module.respond(module.TRUE, module.HIDDEN, time, u)
    random = np.random.default_rng(1000 + seed)
    columns, names = [time, *u.values()], ["time [s]", *(f"{n} [{unit}]" for n, unit in inputs)]
    for name, unit in module.MEASURED.items():
        y = outputs[name]
        columns.append(y + NOISE * np.std(y) * random.standard_normal(len(y)))
        names.append(f"{name} [{unit}]")
    return [n.replace(" []", "") for n in names], np.column_stack(columns)


class Fmu:
    """The derivatives of an FMU for model exchange, by FMPy."""

    def __init__(self, file, start):
        import fmpy
        from fmpy.fmi2 import FMU2Model

        path = str(HERE / file)
        description = fmpy.read_model_description(path, validate=False)
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.states = [self.references[d.variable.derivative.name] for d in description.derivatives]
        self.fmu = FMU2Model(
            guid=description.guid, unzipDirectory=fmpy.extract(path), instanceName="it",
            modelIdentifier=description.modelExchange.modelIdentifier,
        )
        self.fmu.instantiate()
        self.set(start)
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        for _ in range(10):
            if not self.fmu.newDiscreteStates()[0]:
                break
        self.fmu.enterContinuousTimeMode()
        self.start = np.array(self.fmu.getReal(self.states))

    def set(self, values):
        self.fmu.setReal([self.references[n] for n in values], [float(v) for v in values.values()])

    def get(self, names):
        return np.array(self.fmu.getReal([self.references[n] for n in names]))

    def outputs(self, t, x, values, names):
        """OpenModelica's FMUs compute outputs only if they are asked for them before the derivatives."""
        self.place(t, x, values)
        return self.get(names)

    def place(self, t, x, values):
        import ctypes

        n = len(self.states)
        self.fmu.setTime(t)
        if n:
            self.fmu.setContinuousStates((ctypes.c_double * n)(*x), n)
        self.set(values)

    def derivatives(self, t, x, values):
        import ctypes

        n = len(self.states)
        self.place(t, x, values)
        d = (ctypes.c_double * n)()
        if n:
            self.fmu.getDerivatives(d, n)
        return np.array(d)


def agree(module, duration=3.0, parts=8):
    """Largest difference from the FMU with its own parameters, in parts of the signal's standard deviation: RK4, no events."""
    full = np.arange(0.0, module.DURATION, module.STEP)
    u = {name: values for (name, _), values in module.inputs(1, full).items()}
    time = full[full < duration]
    ours = module.respond(module.NOMINAL, {}, time, {n: v[: len(time)] for n, v in u.items()})
    drives = {name: drive(full, values) for name, values in u.items()}
    at = lambda t: {n: d(t) for n, d in drives.items()}
    fmu = Fmu(module.FMU, {**getattr(module, "START", {}), **at(0.0)})
    x, h, seen = np.array(getattr(module, "BEGINS", fmu.start), float), module.STEP / parts, []
    for t in time:
        seen.append(fmu.outputs(t, x, at(t), ours))
        for i in range(parts):
            s = t + i * h
            k1 = fmu.derivatives(s, x, at(s))
            k2 = fmu.derivatives(s + h / 2, x + h / 2 * k1, at(s + h / 2))
            k3 = fmu.derivatives(s + h / 2, x + h / 2 * k2, at(s + h / 2))
            k4 = fmu.derivatives(s + h, x + h * k3, at(s + h))
            x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    for (name, y), other in zip(ours.items(), np.array(seen).T):
        print(f"{module.FMU} {name}: std {np.std(y):.4g}, differs by {np.max(np.abs(y - other)) / np.std(y):.2e}, begins {y[0]:.4g}/{other[0]:.4g}")


def agree_with_events(module, duration=3.0):
    """The same by FMPy's own solver, which handles events."""
    import fmpy

    full = np.arange(0.0, module.DURATION, module.STEP)
    u = {name: values for (name, _), values in module.inputs(1, full).items()}
    time = full[full < duration]
    ours = module.respond(module.NOMINAL, {}, time, {n: v[: len(time)] for n, v in u.items()})
    signals = np.zeros(len(full), [("time", float), *((n, float) for n in u)])
    signals["time"] = full
    for n, values in u.items():
        signals[n] = values
    theirs = fmpy.simulate_fmu(
        str(HERE / module.FMU), fmi_type="ModelExchange", stop_time=duration, output_interval=module.STEP, relative_tolerance=1e-6,
        input=signals, output=list(ours),
    )
    for name, y in ours.items():
        other = np.interp(time, theirs["time"], theirs[name])
        print(f"{module.FMU} {name}: std {np.std(y):.4g}, differs by {np.max(np.abs(y - other)) / np.std(y):.2e}")


def main(name):
    module = sys.modules[name]
    if sys.argv[1:] == ["--agree"]:
        return agree_with_events(module) if getattr(module, "EVENTS", False) else agree(module)
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for seed, kind in [(1, "train"), (2, "test")]:
        header, rows = record(module, seed)
        path = folder / f"{Path(module.__file__).stem}-{kind}.csv"
        np.savetxt(path, rows, fmt="%.9g", delimiter=",", header=",".join(header), comments="")
        print(path, rows.shape, dict(zip(header, np.round(np.std(rows, axis=0), 5))))
