"""Single numbers: gains, natural frequencies, bandwidth, lift-off point; printed against computed."""

import math

import numpy as np
from scipy.optimize import brentq

from controllers import lqr_gain, quanser_matrices
from linear_motor import LinearMotor
from number_sheet_agh import kogut, konieczny
from number_sheet_ajala import ajala
from parameter_sets import ASYMMETRY, G, SETS
from quarter_car import QuarterCar
from sanity import linear_matrices


def frequency(stiffness, mass):
    return math.sqrt(stiffness / mass) / (2.0 * math.pi)


def ratio(damping, stiffness, mass):
    return damping / (2.0 * math.sqrt(stiffness * mass))


def modes(a):
    """Natural frequency and damping ratio of each oscillating pair, and the other eigenvalues."""
    values = sorted(np.linalg.eigvals(a), key=lambda v: (abs(v), v.imag))
    pairs = [v for v in values if v.imag > 1e-9]
    return {"frequency_hz": [abs(v) / (2.0 * math.pi) for v in pairs],
            "damping_ratio": [-v.real / abs(v) + 0.0 if abs(v.real) > 1e-9 * abs(v) else 0.0 for v in pairs],
            "real_eigenvalues": [v.real for v in values if abs(v.imag) <= 1e-9]}


def rig(p):
    """Uncoupled formulas as the TUM tables use them, and the coupled system without friction."""
    ms, mu = p["sprung_mass"], p["unsprung_mass"]
    k, d, kt = p["strut.stiffness"], p["strut.damping"], p["tire.stiffness"]
    return {
        "strut_damping": d,
        "chassis_frequency_hz": frequency(k, ms),
        "chassis_damping_ratio": ratio(d, k, ms),
        "wheel_frequency_hz": frequency(kt, mu),
        "wheel_frequency_with_strut_hz": frequency(k + kt, mu),
        "wheel_damping_ratio": ratio(d, k + kt, mu),
        "coupled": modes(linear_matrices(p)[0]),
    }


# As printed: chassis Hz, zeta, wheel Hz, zeta.
PRINTED = {
    "tum-linear-optimised": [1.39, 0.723, 14.24, 0.284],
    "tum-linear-measured": [1.51, 0.447, 12.59, 0.198],
    "tum-table-7-optimised": [1.49, 0.47, 12.92, 0.212],
    "tum-table-7-measured": [1.51, 0.443, 12.59, 0.196],
    "tum-table-10": [1.5, 0.397, 12.7, 0.18],
}


def tire(p):
    car = QuarterCar(p)
    k, q = p["tire.stiffness"], p["tire.quadratic"]
    numeric = brentq(lambda c: car.tire.static_load + k * c + q * c * c, -k / (2.0 * q), 0.0, xtol=1e-18)
    assert abs(numeric / car.tire.lift_off_compression - 1.0) < 1e-12
    return {
        "static_load": car.tire.static_load,
        "lift_off_compression": car.tire.lift_off_compression,
        "parabola_turns_at": -k / (2.0 * q),
        "force_returns_to_lift_off_at": -k / q - car.tire.lift_off_compression,
        "tangent_rate_at_static_equilibrium": k,
        "tangent_rate_if_counted_from_unloaded_tyre": math.sqrt(k * k + 4.0 * q * car.tire.static_load),
    }


def motor():
    m = LinearMotor()

    def gain(f):
        s = 2j * math.pi * f
        return abs(m.readout * m.delay / (s + m.delay) * m.gain / (s + m.pole))

    # |G|^2 = |G(0)|^2 / 2 is quadratic in w^2: (w^2 + a^2)(w^2 + b^2) = 2 a^2 b^2.
    a2, b2 = m.pole**2, m.delay**2
    w2 = 0.5 * (-(a2 + b2) + math.sqrt((a2 + b2) ** 2 + 4.0 * a2 * b2))
    half_power = math.sqrt(w2) / (2.0 * math.pi)
    decibel = brentq(lambda f: 20.0 * math.log10(gain(f) / gain(0.0)) + 3.0, 1.0, 200.0, xtol=1e-13)
    return {
        "static_gain_a_per_v": m.static_gain,
        "force_at_10_v": 10.0 * m.static_gain * m.force_constant,
        "half_power_frequency_hz": half_power,
        "minus_3_db_frequency_hz": decibel,
        "i2t_capacity_a2s": m.capacity,
    }


def lqr(name):
    p = SETS[name]
    gain, residual = lqr_gain(p)
    assert residual < 1e-10, residual
    a, b = quanser_matrices(p)
    return {"k_us": p["tire.stiffness"], "gain": gain, "closed_loop": modes(a - b @ np.array([gain]))}


def tum_errors():
    """Where the printed form cannot be: fourth entry of E in eq. 9, the strut's own rate, the force of 10 V."""
    linear, table_10, m = SETS["tum-linear-optimised"], SETS["tum-table-10"], LinearMotor()
    return {
        "eq_9_fourth_entry": {"printed": 1.0, "computed": linear["tire.damping"] / linear["unsprung_mass"]},
        # c_c = i^2 c_strut (eq. 13); with Table 10's i^-2 the strut would be softer than its effect at the wheel.
        "strut_rate": {"by_eq_13": table_10["strut.stiffness"] / 0.392**2,
                       "by_table_10": table_10["strut.stiffness"] * 0.392**2},
        "force_at_10_v": {"printed_1_kn_per_a": 10.0 * m.static_gain * 1e3, "computed": 10.0 * m.static_gain * 100.0,
                          "peak_of_table_3": 3200.0},
    }


def numbers():
    measured = SETS["tum-table-7-measured"]
    return {
        "g": G,
        "damper_asymmetry": ASYMMETRY,
        "lqr": {"printed": [24.66, 48.87, -0.47, 3.68],
                "quanser": lqr("quanser"), "quanser-table-3-1": lqr("quanser-table-3-1")},
        "rigs": {name: rig(p) | ({"printed": PRINTED[name]} if name in PRINTED else {})
                 for name, p in SETS.items()},
        "tire": {name: tire(p) for name, p in SETS.items() if p["tire.quadratic"]},
        "linearised_tire_rate_tum": {
            "printed": 152186.0,
            "compression_where_measured_tangent_has_it":
                (152186.0 - measured["tire.stiffness"]) / (2.0 * measured["tire.quadratic"])},
        "linear_motor": motor(),
        "tum_errors": tum_errors(),
        "konieczny": konieczny(),
        "ajala": ajala(),
        "kogut": kogut(),
    }
