"""The case: the AGH rig and its servohydraulic actuator apart, and both in one, on the same stimulus."""

import contextlib
import time
from dataclasses import dataclass

import numpy as np
from coupled import Coupled, RunAway
from methods import Aitken, FixedPoint, Foreseen, GaussSeidel, Newton, NotConverged, anderson, constant, extrapolated

COMPONENTS = {"rig": "KoniecznyQuarterCar", "actuator": "KoniecznyServoHydraulicActuator"}
# With the size that force and velocity have.
CONNECTIONS = {
    ("actuator.force", "rig.actuator.force"): 1e3,
    ("rig.suspension.velocity", "actuator.suspension.velocity"): 0.1,
}
# What is compared, by its name in the pair and in the one.
SIGNALS = {
    "rig.body.position": "one.body.position",
    "rig.wheel.position": "one.wheel.position",
    "actuator.force": "one.actuator.force",
}
# The actuator's estimate of what it moves: m_1 m_2/(m_1 + m_2).
MASS = 86.0 * 11.5 / (86.0 + 11.5)
LOADED = "constant inputs, load.mass"
METHODS = {
    "constant inputs (Jacobi)": lambda: constant,
    LOADED: lambda: constant,
    "input derivatives": lambda: extrapolated,
    "Gauss–Seidel, actuator first": lambda: GaussSeidel("actuator", "rig"),
    "Gauss–Seidel, rig first": lambda: GaussSeidel("rig", "actuator"),
    "iteration, Aitken": lambda: FixedPoint(Aitken(), "actuator", "rig"),
    "iteration, Anderson": lambda: FixedPoint(anderson, "actuator", "rig"),
    "iteration, interface Jacobian": Newton,
    "interface Jacobian, constant inputs": lambda: Foreseen(0),
    "interface Jacobian": lambda: Foreseen(2),
}
# What is counted: steps, states kept and gone back to, slopes, directional derivatives.
KINDS = ("step", "state", "slope", "derivative")
STEPS = [0.1e-3, 0.25e-3, 0.5e-3, 1e-3, 2e-3, 5e-3]
STOP, FINEST = 0.2, 0.05e-3
# The stimulus is a record with a row every 10 ms, a multiple of every step, and straight lines between.
INTERVAL = 0.01


def line(function):
    """A record of a function: value and slope at a time."""

    def course(now):
        row = np.floor(now / INTERVAL + 1e-6)
        value, after = function(row * INTERVAL), function((row + 1.0) * INTERVAL)
        slope = (after - value) / INTERVAL
        return value + slope * (now - row * INTERVAL), slope

    return course


def flat(_):
    """Nothing happens."""
    return 0.0, 0.0


voltage = line(lambda now: 3.0 * np.sin(60.0 * now))
road = line(lambda now: 5e-3 * (1.0 - np.cos(30.0 * now)))


def road_velocity(now):
    """The slope of the record, which does not change within a step."""
    return road(now)[1], 0.0


def pair(folder, name, step, pressure=None):
    """Rig and actuator as two FMUs; with a `pressure` at the start, nothing else happens."""
    method, parameters = METHODS[name](), {}
    if name == LOADED:
        parameters = {"actuator.load.mass": MASS, "actuator.load.interval": step}
    stimulus = {"actuator.voltage": voltage, "rig.road.position": road, "rig.road.velocity": road_velocity}
    if pressure is not None:
        stimulus, parameters = dict.fromkeys(stimulus, flat), parameters | {"actuator.pressure": pressure}
    return Coupled(folder, COMPONENTS, CONNECTIONS, stimulus, method, parameters)


def reference(folder, stop=STOP, pressure=None):
    """The same in one FMU, in steps of `FINEST`."""
    stimulus = {"one.voltage": voltage, "one.road.position": road}
    parameters = {"one.solver.tolerance": 1e-10}
    if pressure is not None:
        stimulus, parameters = dict.fromkeys(stimulus, flat), parameters | {"one.pressure": pressure}
    with Coupled(folder, {"one": "KoniecznyServoSuspension"}, {}, stimulus, constant, parameters) as system:
        return system.run(stop, FINEST, list(SIGNALS.values()))


def errors(result, truth, step):
    """The largest differences of the signals, in percent of the ranges that they have."""
    every = round(step / FINEST)
    return [
        100.0 * float(np.abs(result[name] - truth[one][::every]).max() / np.ptp(truth[one]))
        for name, one in SIGNALS.items()
    ]


@dataclass
class Run:
    """What came of a method at a step. `errors` is empty where it does not work."""

    errors: list
    # Calls a step, by `KINDS`.
    calls: dict
    # Of the processor, without loading the FMUs.
    seconds: float

    @property
    def works(self):
        return bool(self.errors)


def run(folder, name, step, truth):
    """The pair on the stimulus, against the one."""
    found = []
    with pair(folder, name, step) as system:
        begun = time.process_time()
        with contextlib.suppress(RunAway, NotConverged):
            found = errors(system.run(STOP, step, list(SIGNALS)), truth, step)
        seconds = time.process_time() - begun
        calls = {kind: system.calls[kind] * step / STOP for kind in KINDS}
    return Run(found, calls, seconds)
