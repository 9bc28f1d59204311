"""Single numbers of the two AGH sources: Konieczny and Kogut."""

import math

import numpy as np
from scipy.linalg import expm

from cases_kogut import I1, I2, R, RIG
from cases_konieczny import CYLINDER
from parameter_sets import SETS
from sanity import linear_matrices
from sas import SasRig
from servo import IDENTIFIED_A, phenomenological


def symbols():
    """Konieczny's notations by their symbols."""
    rig, c = SETS["konieczny"], CYLINDER
    return {"m1": rig["unsprung_mass"], "m2": rig["sprung_mass"], "k1": rig["tire.stiffness"],
            "k2": rig["strut.stiffness"], "b1": rig["tire.damping"], "b2": rig["strut.damping"],
            "A_a": c["cylinder.area"], "C_tm": c["cylinder.leakage"], "tau": c["spool.time_constant"],
            "k_sv": c["spool.gain"],
            "alpha": 4.0 * c["fluid.bulk_modulus"] / (c["cylinder.volume"] + c["cylinder.hose_volume"])}


def flow_gain():
    """l C_d sqrt(P_z / rho) of eq. 2.23."""
    c = CYLINDER
    velocity = math.sqrt(c["supply.pressure"] / c["fluid.density"])
    return c["valve.perimeter"] * c["valve.discharge_coefficient"] * velocity


def sorted_eigenvalues(a):
    return sorted(np.linalg.eigvals(a), key=lambda v: (abs(v), v.imag))


def parts(values):
    return [[v.real, v.imag] for v in values]


def identified():
    values = sorted_eigenvalues(IDENTIFIED_A)
    pairs = [v for v in values if v.imag > 0.0]
    return {
        "eigenvalues": {"printed": [[-1.0, 0.0], [-1.439, 0.0], [-7.495, -20.570], [-7.495, 20.570],
                                    [-79.786, -77.775], [-79.786, 77.775]], "computed": parts(values)},
        "frequency_hz": {"printed": [3.4843, 17.733], "computed": [abs(v) / (2.0 * math.pi) for v in pairs]},
        "damping_ratio": {"printed": [0.34234, 0.71607], "computed": [-v.real / abs(v) for v in pairs]},
        "real_frequency_hz": {"printed": [0.15915, 0.22894],
                              "computed": [abs(v) / (2.0 * math.pi) for v in values if v.imag == 0.0]},
        "characteristic_polynomial": {"printed": [1.0, 177.0, 15713.0, 300095.0, 6612388.0, 14887015.0, 8559185.0],
                                      "computed": np.poly(IDENTIFIED_A).real.tolist()},
        "rest_on_a_road_of_one": (np.linalg.solve(-IDENTIFIED_A, [0, 212, 0, 949, 4, 0])[[0, 2]]).tolist(),
    }


def linearised():
    """Eq. 2.17 with Phi of eq. 2.23: x_6 acts on the pressure."""
    p = symbols()
    a, _ = phenomenological(p)
    a[4, 5] = p["alpha"] * flow_gain()
    return a


def regression():
    """A plane through Phi of eq. 2.18 over +-7 MPa and +-0.25 mm, evenly spaced points."""
    c, alpha = CYLINDER, symbols()["alpha"]
    pressure, spool = np.meshgrid(np.linspace(-7e6, 7e6, 401), np.linspace(-0.25e-3, 0.25e-3, 401))
    root = np.sqrt((c["supply.pressure"] - np.sign(spool) * pressure) / c["fluid.density"])
    phi = alpha * c["valve.perimeter"] * c["valve.discharge_coefficient"] * spool * root
    columns = np.stack([pressure.ravel(), spool.ravel()], axis=1)
    return np.linalg.lstsq(columns, phi.ravel(), rcond=None)[0].tolist()


def exchange():
    """Spectral radius of one exchange between the rig (force in, velocity out) and the actuator (velocity in, force
    out, valve closed), both linear, by scheme and step."""
    p = symbols()
    a, b = linear_matrices(SETS["konieczny"])
    b, measured = b[:, 2:], np.array([[0.0, 1.0, 0.0, -1.0]])
    pressure, push = -p["alpha"] * p["C_tm"], -p["alpha"] * p["A_a"]
    force = p["A_a"]

    def integrals(matrix, column, h):
        """Transition, and what a constant and a slope of the input add."""
        n = len(matrix)
        block = np.zeros((n + 2, n + 2))
        block[:n, :n], block[:n, n:n + 1], block[n, n + 1] = matrix, column, 1.0
        return np.split(expm(block * h)[:n], [n, n + 1], axis=1)

    def radius(h, scheme):
        rig, rig_step, rig_ramp = integrals(a, b, h)
        oil, oil_step, oil_ramp = integrals(np.array([[pressure]]), np.array([[push]]), h)
        one = np.zeros((5, 5))
        one[:4, :4], one[:4, 4:], one[4:, :4], one[4:, 4:] = rig, rig_step * force, oil_step @ measured, oil
        if scheme == "jacobi with slopes":
            velocity = np.hstack([measured @ a, measured @ b * force])
            one[:4] += rig_ramp * force @ np.hstack([push * measured, [[pressure]]])
            one[4:] += oil_ramp @ velocity
        if scheme == "gauss-seidel":
            one[4:] = oil_step @ measured @ one[:4] + np.hstack([np.zeros((1, 4)), oil])
        return float(np.abs(np.linalg.eigvals(one)).max())

    return {scheme: {f"{1e3 * h:g} ms": radius(h, scheme) for h in (1e-3, 0.5e-3, 0.2e-3)}
            for scheme in ("jacobi", "gauss-seidel", "jacobi with slopes")}


def konieczny():
    p, c = symbols(), CYLINDER
    values = sorted_eigenvalues(linearised())
    hydraulic = values[-1]
    return {
        "alpha": {"printed": 44.4495, "computed": p["alpha"]},
        "discharge_coefficient": {"printed": 0.611, "computed": math.pi / (math.pi + 2.0)},
        "spool_perimeter": {"printed": 15.708e-3, "computed": math.pi * 5e-3},
        "piston_area": {"printed": 0.765786e-3, "volume_over_stroke": c["cylinder.volume"] / 0.06},
        "phi": {"linear_in_spool": p["alpha"] * flow_gain(),
                "regression": {"printed": [-341.2, 4.666e13], "computed": regression()}},
        "identified": identified(),
        "linearised_eigenvalues": parts(values),
        "hydraulic_mode": {"damped_frequency_hz": abs(hydraulic.imag) / (2.0 * math.pi),
                           "damping_ratio": -hydraulic.real / abs(hydraulic)},
        "spectral_radius_of_an_exchange": exchange(),
    }


def kogut():
    rig = SasRig(RIG, {})
    locked = SasRig(RIG, {"wheel_arm.locked": True})
    ks, kt = 528.57 * I2 / 0.191, 1.08e5 * I1 / R
    rest = rig.rest()

    def tire(angle, height):
        return rig.contact([angle, 0.0, 0.0, 0.0], [0.0, height, 0.0])[1]
    h = 1e-6
    stiffness = -(locked.moments([0.0, 0.0, 0.57 + h, 0.0], [0.0] * 3, "contact")[1]
                  - locked.moments([0.0, 0.0, 0.57 - h, 0.0], [0.0] * 3, "contact")[1]) / (2.0 * h)
    return {
        "rest": {"printed": [-0.195, 0.3540], "computed": rest, "with_one_lever":
                 SasRig(RIG, {"spring.lever": "Exact"}).rest()},
        "rest_of_part_one": {"a1_l_s": 528.57 * locked.spring(0.57)[0], "a2_cos": 22.07 * math.cos(0.57),
                             "printed_angle": 0.57, "computed_angle": locked.rest(guess=(0.0, 0.57))[1]},
        "k_s": {"printed": 3.79e3, "computed": ks},
        "k_t": {"printed": 1.09e5, "computed": kt},
        "b_t": {"printed": 305.27, "computed": 1.44e3 * I1},
        "a_4": {"printed": 4.92e3, "computed": ks * 0.275 / I1},
        "k_1": {"printed": 4.72, "computed": 1.0 / I1},
        "tire_compression_lowest": {"printed": 0.0015, "computed": tire(-0.19, 0.04)},
        "tire_compression_highest": {"printed": 0.002, "computed": tire(-0.167, 0.045)},
        "encoder_step_rad": {"printed": 0.001534, "computed": 2.0 * math.pi / 4096},
        "tire_damping_at_rest": 1.44e3 * I1 / rig.contact([-0.195, 0, 0, 0], [0.0] * 3)[0],
        "body_frequency_hz": math.sqrt(stiffness / I2) / (2.0 * math.pi),
        "load_on_eccentric_at_rest": {lever: SasRig(RIG, {"spring.lever": lever}).load()
                                      for lever in ("Printed", "Exact")},
    }
