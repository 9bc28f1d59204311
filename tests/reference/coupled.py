"""Closed loops as one ODE, the sampled controller handled exactly.

At t_k = k * 1 ms the controller reads the state at t_k and its force acts on [t_k, t_k + 1 ms].
Between two ticks rig, motor and road are one continuous system: nothing is exchanged, so
there is no coupling error. A row at t_k is read after the tick, with the road's value from
the right.
"""

import math

import numpy as np
from scipy.linalg import solve_continuous_are

from integrate import advance
from models import LinearMotor, QuarterCar
from parameter_sets import SETS
from roads import Road

# Quanser 3.1.1.
Q_WEIGHTS = [450.0, 30.0, 5.0, 0.01]
R_WEIGHT = 0.01


def quanser_matrices(p):
    """A and B of Quanser eq. 2.23: deflection, body velocity, tyre deflection, wheel velocity."""
    ms, mu = p["sprung_mass"], p["unsprung_mass"]
    k, d, kt, dt = p["strut.stiffness"], p["strut.damping"], p["tire.stiffness"], p["tire.damping"]
    a = np.array([[0.0, 1.0, 0.0, -1.0],
                  [-k / ms, -d / ms, 0.0, d / ms],
                  [0.0, 0.0, 0.0, 1.0],
                  [k / mu, d / mu, -kt / mu, -(d + dt) / mu]])
    return a, np.array([[0.0], [1.0 / ms], [0.0], [-1.0 / mu]])


def lqr_gain(p, weights=Q_WEIGHTS, r=R_WEIGHT):
    """K of F = -K x (Quanser 2.2.3), and the residual of the Riccati equation."""
    a, b = quanser_matrices(p)
    q = np.diag(weights)
    x = solve_continuous_are(a, b, q, np.array([[r]]))
    residual = a.T @ x + x @ a - x @ b @ b.T @ x / r + q
    return (b.T @ x / r)[0].tolist(), float(np.abs(residual).max() / np.abs(q).max())


class ActiveRig:
    """Quarter car and linear motor; inputs: road position and velocity, force reference."""

    def __init__(self, rig, motor):
        self.rig, self.motor = rig, motor

    def split(self, x, u):
        rig, motor = x[:4], x[4:]
        force = self.motor.output(motor, None, None)[1]
        return rig, [u[0], u[1], force], motor, [0.0, u[2]]

    def derivative(self, x, u, mode):
        rig, road, motor, command = self.split(x, u)
        return (self.rig.derivative(rig, road, mode[0])
                + self.motor.derivative(motor, command, mode[1]))

    def mode(self, x, u):
        rig, road, motor, command = self.split(x, u)
        return self.rig.mode(rig, road), self.motor.mode(motor, command)

    def guards(self, x, u):
        rig, road, motor, command = self.split(x, u)
        return (*self.rig.guards(rig, road), *self.motor.guards(motor, command))

    def watched(self, mode):
        return self.rig.watched(mode[0]) + [(i + 2, d) for i, d in self.motor.watched(mode[1])]

    def after(self, mode, guard, x, u):
        rig, road, motor, command = self.split(x, u)
        if guard < 2:
            return self.rig.after(mode[0], guard, rig, road), mode[1]
        return mode[0], self.motor.after(mode[1], guard - 2, motor, command)

    def settle(self, x, mode):
        return x[:4] + self.motor.settle(x[4:], mode[1])


def loop(model, state, road, control, stop, solver, step=1e-3):
    """Yields (t, state, road position, road velocity, force) after each tick."""
    count, marks = round(stop / step), road.breaks(stop)
    for k in range(count + 1):
        t0, t1 = k * step, (k + 1) * step
        force = control(k, state, road(t0, t0 + 1e-9))
        yield (t0, state, *road(t0, t0 + 1e-9), force)
        if k == count:
            return
        # A piece shorter than 1 ns is the rounding of a mark that lies on the grid.
        ends = [t0] + [m for m in marks if t0 + 1e-9 < m < t1 - 1e-9] + [t1]
        for a, b in zip(ends, ends[1:]):
            middle = 0.5 * (a + b)
            state = advance(model, a, b, state, lambda t: (*road(t, middle), force), solver)


QUANSER_LQR = {
    "case": "quanser-lqr",
    "kind": "coupled",
    "description": "Quanser 3.1.1: square road, LQR switched on at 5 s. The K_us = 2500 set.",
    "step": 1e-3,
    "stop": 10.0,
    "rows_every": 25,
    "components": {
        "road": {"fmu": "Road", "kind": "square",
                 "parameters": {"amplitude": 0.01, "frequency": 0.3, "edge_time": 0.02, "start": 0.0}},
        "rig": {"fmu": "QuarterCar", "parameter_set": "quanser"},
        "controller": {"fmu": "LqrController", "period": 1e-3, "switch_on_time": 5.0,
                       "q": Q_WEIGHTS, "r": R_WEIGHT,
                       "law": "force = -K [suspension.deflection, body.velocity, tire.deflection, wheel.velocity]"},
    },
    "connections": [["road.position", "rig.road.position"], ["road.velocity", "rig.road.velocity"],
                    ["rig.suspension.deflection", "controller"], ["rig.body.velocity", "controller"],
                    ["rig.tire.deflection", "controller"], ["rig.wheel.velocity", "controller"],
                    ["controller.force", "rig.actuator.force"]],
}

TUM_ACTIVE = {
    "case": "tum-active",
    "kind": "coupled",
    "description": "TUM Table 10 rig with its linear motor, Skyhook (Ajala eq. 28) on the body "
                   "velocity, ISO 8608 class D road. The road's velocity jumps at its start.",
    "step": 1e-3,
    "stop": 10.0,
    "rows_every": 25,
    "components": {
        "road": {"fmu": "Road", "kind": "iso8608",
                 "parameters": {"road_class": "D", "speed": 10.0, "seed": 1, "start": 0.5}},
        "rig": {"fmu": "QuarterCar", "parameter_set": "tum-table-10",
                "settings": {"tire.lift_off": True}},
        "controller": {"fmu": "Skyhook", "period": 1e-3, "damping": 1500.0,
                       "law": "force = -damping body.velocity"},
        "motor": {"fmu": "LinearMotor", "inputs": {"voltage": 0.0}},
    },
    "connections": [["road.position", "rig.road.position"], ["road.velocity", "rig.road.velocity"],
                    ["rig.body.velocity", "controller"],
                    ["controller.force", "motor.force_reference"],
                    ["motor.force", "rig.actuator.force"]],
}


def road_of(case):
    component = case["components"]["road"]
    return Road(component["kind"], **component["parameters"])


def columns(*extra):
    return (["time", "road.position", "road.velocity"]
            + [f"rig.{name}" for name in QuarterCar.states + QuarterCar.outputs] + list(extra))


def quanser_lqr(case, solver):
    rig = QuarterCar(SETS["quanser"])
    gain, _ = lqr_gain(SETS["quanser"])
    first = round(case["components"]["controller"]["switch_on_time"] / case["step"])

    def control(k, x, road):
        measured = [x[0] - x[2], x[1], x[2] - road[0], x[3]]
        return -math.fsum(g * m for g, m in zip(gain, measured)) if k >= first else 0.0

    rows = []
    for k, (t, x, zr, vr, force) in enumerate(loop(rig, [0.0] * 4, road_of(case), control,
                                                   case["stop"], solver)):
        if k % case["rows_every"] == 0:
            u = (zr, vr, force)
            rows.append([t, zr, vr, *x, *rig.output(x, u, rig.mode(x, u)), force])
    return columns("controller.force"), rows, {}


def tum_active(case, solver):
    rig = QuarterCar(SETS["tum-table-10"], lift_off=True)
    motor = LinearMotor()
    model = ActiveRig(rig, motor)
    damping = case["components"]["controller"]["damping"]
    rows, airborne, content = [], 0, 0.0
    for k, (t, x, zr, vr, force) in enumerate(loop(model, [0.0] * 7, road_of(case),
                                                   lambda _k, x, _road: -damping * x[1],
                                                   case["stop"], solver)):
        current, actuator = motor.output(x[4:], None, None)
        u = (zr, vr, actuator)
        mode = rig.mode(x[:4], u)
        airborne += mode != "contact"
        content = max(content, x[6])
        if k % case["rows_every"] == 0:
            rows.append([t, zr, vr, *x[:4], *rig.output(x[:4], u, mode), force, current, actuator])
    return (columns("controller.force", "motor.current", "motor.force"), rows,
            {"ticks_without_contact": airborne, "largest_i2t_share": content / motor.capacity})
