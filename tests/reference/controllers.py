"""Sampled controllers: what the tick k leaves is the command until the next."""

import math

import numpy as np
from scipy.linalg import solve_continuous_are

from integrate import Smooth

# Quanser 3.1.1.
WEIGHTS = {"weight.suspension_deflection": 450.0, "weight.body_velocity": 30.0,
           "weight.tire_deflection": 5.0, "weight.wheel_velocity": 0.01, "weight.force": 0.01}


class Controller(Smooth):
    """Its outputs are its memory."""

    def output(self, _state, u, _mode):
        return u[len(self.inputs):]


def quanser_matrices(p):
    """A and B of Quanser eq. 2.23: deflection, body velocity, tyre deflection, wheel velocity."""
    ms, mu = p["sprung_mass"], p["unsprung_mass"]
    k, d, kt, dt = p["strut.stiffness"], p["strut.damping"], p["tire.stiffness"], p["tire.damping"]
    a = np.array([[0.0, 1.0, 0.0, -1.0],
                  [-k / ms, -d / ms, 0.0, d / ms],
                  [0.0, 0.0, 0.0, 1.0],
                  [k / mu, d / mu, -kt / mu, -(d + dt) / mu]])
    return a, np.array([[0.0], [1.0 / ms], [0.0], [-1.0 / mu]])


def lqr_gain(p, weights=WEIGHTS):
    """K of F = -K x (Quanser 2.2.3), and the residual of the Riccati equation."""
    a, b = quanser_matrices(p)
    *diagonal, r = weights.values()
    q = np.diag(diagonal)
    x = solve_continuous_are(a, b, q, np.array([[r]]))
    residual = a.T @ x + x @ a - x @ b @ b.T @ x / r + q
    return (b.T @ x / r)[0].tolist(), float(np.abs(residual).max() / np.abs(q).max())


class LqrController(Controller):
    """F = -K x from the switch-on time on, Quanser 2.2.3 and 3.1."""

    inputs = ["suspension.deflection", "body.velocity", "tire.deflection", "wheel.velocity"]
    outputs = ["force"]

    def __init__(self, parameters, _settings=None):
        self.period, self.begin = parameters["period"], parameters["switch_on_time"]
        self.gain, _ = lqr_gain(parameters, {name: parameters[name] for name in WEIGHTS})

    def tick(self, _memory, _state, u, k):
        # A tick on the switch-on time counts, whatever the product's rounding.
        on = k * self.period >= self.begin * (1.0 - 1e-12)
        return [-math.fsum(g * x for g, x in zip(self.gain, u)) if on else 0.0]


class Skyhook(Controller):
    """F_ref = -C_SH z_a', Ajala eq. 28."""

    inputs = ["body.velocity"]
    outputs = ["force"]

    def __init__(self, parameters, _settings=None):
        self.period, self.damping = parameters["period"], parameters["damping"]

    def tick(self, _memory, _state, u, _k):
        return [-self.damping * u[0]]


class ModalSkyhook(Controller):
    """Ajala eq. 47-49, in the form that unit demands come out as unit: what corners at (x, y) do to heave, roll and
    pitch is sum F, sum y F and -sum x F. Each axle and each side takes the other's share."""

    inputs = ["heave.velocity", "roll.speed", "pitch.speed"]
    outputs = [f"{corner}.force" for corner in ("front_left", "front_right", "rear_left", "rear_right")]

    def __init__(self, parameters, _settings=None):
        p = parameters
        self.period = p["period"]
        self.damping = [p[f"damping.{mode}"] for mode in ("heave", "roll", "pitch")]
        front, rear, left, right = (p[f"geometry.{side}"] for side in ("front", "rear", "left", "right"))
        # Columns heave, roll and pitch of M, times the wheelbase and the track.
        self.matrix = np.array([[rear * right, rear, -right], [rear * left, -rear, -left],
                                [front * right, front, right], [front * left, -front, left]]
                               ) / ((front + rear) * (left + right))
        effect = np.array([[1, 1, 1, 1], [left, -right, left, -right], [-front, -front, rear, rear]])
        assert np.abs(effect @ self.matrix - np.eye(3)).max() < 1e-12

    def tick(self, _memory, _state, u, _k):
        return (self.matrix @ [-c * rate for c, rate in zip(self.damping, u)]).tolist()
