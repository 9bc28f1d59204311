"""Single numbers of Ajala: the equivalent mechanical system, the distribution of modal forces."""

import math

import numpy as np

from cases_ajala import ACTUATOR, ACTUATOR_LINEAR
from cases_full_car import GEOMETRY
from controllers import ModalSkyhook
from pump import PumpHydraulicActuator, PumpHydraulicActuatorLinear


def transfer(model, s):
    """Of the force, from torque and from suspension velocity, by the model's own rates."""
    n, zero = len(model.states), [0.0] * len(model.states)

    def column(function, state, u):
        return np.array(function(state, u, ()), dtype=float)
    unit = np.eye(n).tolist()
    a = np.stack([column(model.derivative, x, [0.0, 0.0]) for x in unit], axis=1)
    b = np.stack([column(model.derivative, zero, u) for u in ([1.0, 0.0], [0.0, 1.0])], axis=1)
    c = np.array([[column(model.output, x, [0.0, 0.0])[0] for x in unit]])
    d = np.array([[column(model.output, zero, u)[0] for u in ([1.0, 0.0], [0.0, 1.0])]])
    return (c @ np.linalg.solve(s * np.eye(n) - a, b) + d)[0]


def mechanical(model, s):
    """The same from eq. 24-26: F = (c s + k)(z_e - z_m), m s^2 z_m = F - F_m, z_e = -v / s."""
    spring = model.damping * s + model.stiffness
    mass = model.mass * s * s
    return np.array([model.a0 / model.vc * spring, -mass * spring / s]) / (mass + spring)


def difference():
    """Of eq. 18 and eq. 26, relative, over frequencies of 0.1 to 100 Hz."""
    model = PumpHydraulicActuatorLinear(ACTUATOR_LINEAR, {})
    return max(float(np.abs(transfer(model, s) / mechanical(model, s) - 1.0).max())
               for s in 2j * math.pi * np.logspace(-1.0, 2.0, 31))


def distribution(last, denominator):
    """Heave force, roll and pitch moment that a unit pitch demand comes out as, by the last entry of M (eq. 49)."""
    model = ModalSkyhook({"damping.heave": 0.0, "damping.roll": 0.0, "damping.pitch": 0.0, "period": 1e-3} | GEOMETRY)
    front, rear, left, right = (GEOMETRY[f"geometry.{side}"] for side in ("front", "rear", "left", "right"))
    matrix = model.matrix * (front + rear) * (left + right) / denominator
    matrix[3, 2] = last / denominator
    effect = np.array([[1, 1, 1, 1], [left, -right, left, -right], [-front, -front, rear, rear]])
    return (effect @ matrix)[:, 2].tolist()


def ajala():
    linear = PumpHydraulicActuatorLinear(ACTUATOR_LINEAR, {})
    natural = math.sqrt(linear.stiffness / linear.mass)
    front, rear, left, right = (GEOMETRY[f"geometry.{side}"] for side in ("front", "rear", "left", "right"))
    assert difference() < 1e-12
    full = PumpHydraulicActuator(ACTUATOR["Soft"], {})
    return {
        "equivalent_mechanical_system": {
            "mass": linear.mass, "stiffness": linear.stiffness, "damping": linear.damping,
            "natural_frequency_hz": natural / (2.0 * math.pi),
            "damping_ratio": linear.damping / (2.0 * linear.mass * natural)},
        "static_force": (full.ak - full.ar) * full.p0,
        "unit_pitch_demand": {
            "corrected": distribution(left, (front + rear) * (left + right)),
            "last_entry_as_printed": distribution(-left, (front + rear) * (left + right)),
            # w_f, w_r: nothing else with these letters than l_f and w_r.
            "denominator_as_printed": distribution(left, (front + rear) * (front + right))},
    }
