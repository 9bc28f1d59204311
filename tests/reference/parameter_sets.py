"""Parameter sets of the quarter car, SI units, each with its source.

TUM: tum-quarter-vehicle-rig, Quanser: quanser-active-suspension,
Konieczny: konieczny-electrohydraulic-suspension, Ajala: ajala-electro-hydraulic-active-suspension.
"""

import math

G = 9.80665

# TUM Table 9, measured: compression 521, rebound 994 N s/m. The characteristic itself is a
# lost figure; its ratio is kept and scaled to the mean damping of each nonlinear set.
ASYMMETRY = (994.0 - 521.0) / (994.0 + 521.0)
# TUM: k_f = 125 s/m, used as tanh(v k_f).
V0 = 1.0 / 125.0


def damping_from_ratio(zeta, stiffness, mass):
    """zeta = d / (2 sqrt(c m)), the uncoupled formula behind the TUM tables."""
    return 2.0 * zeta * math.sqrt(stiffness * mass)


def linear(ms, mu, k, d, kt, dt):
    """A set with every nonlinear effect at its neutral value."""
    return {
        "sprung_mass": ms,
        "unsprung_mass": mu,
        "strut.stiffness": k,
        "strut.damping": d,
        "strut.asymmetry.ratio": 0.0,
        "strut.asymmetry.smoothing": 0.005,
        "strut.coulomb.force": 0.0,
        "strut.coulomb.velocity": V0,
        "guide.coulomb.force": 0.0,
        "guide.coulomb.velocity": V0,
        "tire.stiffness": kt,
        "tire.quadratic": 0.0,
        "tire.damping": dt,
        "tire.coulomb.force": 0.0,
        "tire.coulomb.velocity": V0,
    }


def nonlinear(base, quadratic, strut, guide, tire):
    """Adds asymmetric damper, quadratic tyre and the three Coulomb frictions."""
    return base | {
        "strut.asymmetry.ratio": ASYMMETRY,
        "strut.coulomb.force": strut,
        "guide.coulomb.force": guide,
        "tire.quadratic": quadratic,
        "tire.coulomb.force": tire,
    }


SETS = {
    # Quanser Table 3.1, with K_us = 2500 N/m, to which the printed gain belongs.
    "quanser": linear(2.45, 1.0, 900.0, 7.5, 2500.0, 5.0),
    # Quanser Table 3.1 as printed.
    "quanser-table-3-1": linear(2.45, 1.0, 900.0, 7.5, 1250.0, 5.0),
    # Konieczny, Notations: m2, m1, k2, b2, k1, b1 (all six are given).
    "konieczny": linear(86.0, 11.5, 8652.0, 1161.2, 37412.0, 72.0),
    # Ajala (27) has no dampers and the paper gives no values. Assumed: corner of a
    # mid-size car, body near 1.2 Hz, wheel near 14.3 Hz (Fig. 4).
    "ajala": linear(350.0, 36.0, 20000.0, 0.0, 290000.0, 0.0),
    # TUM Table 9.
    "tum-linear-optimised": linear(91.23, 22.25, 6952.0, 1152.0, 178000.0, 123.0),
    "tum-linear-measured": linear(89.56, 23.92, 8250.0, 758.0, 149693.0, 100.0),
    # TUM Table 7 prints no damping; derived from its chassis damping ratio.
    "tum-table-7-optimised": nonlinear(
        linear(91.23, 22.25, 7980.0, damping_from_ratio(0.47, 7980.0, 91.23), 138820.0, 37.9),
        4075400.0, strut=105.0, guide=23.8, tire=62.8),
    "tum-table-7-measured": nonlinear(
        linear(89.56, 23.92, 8250.0, damping_from_ratio(0.443, 8250.0, 89.56), 149693.0, 50.0),
        3940000.0, strut=100.0, guide=10.0, tire=60.0),
    # TUM Table 10; 707 N s/m from zeta = 0.397.
    "tum-table-10": nonlinear(
        linear(94.38, 23.92, 8400.0, 707.0, 152140.0, 50.0),
        4075400.0, strut=115.0, guide=20.0, tire=0.0),
}

# TUM eq. 10-11 and 3.2.2. 100 N/A instead of the printed 1 kN/A: only then does 10 V
# give the motor's 3200 N peak. The I2t rule is TUM eq. 1, for this motor's limits.
MOTOR = {
    "electric_pole": 320.4019,
    "input_gain": 1.2131,
    "delay_pole": 250.0,
    "current_gain": 839.4076,
    "force_constant": 100.0,
    "voltage_limit": 10.0,
    "peak_current": 32.0,
    "continuous_current": 8.0,
    "peak_time": 1.0,
    "fade": 0.02,
}
