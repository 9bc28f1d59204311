"""Checks on the references that need no second integration method."""

import math

import numpy as np
from scipy.integrate import quad
from scipy.linalg import expm
from scipy.signal import welch

from integrate import REFERENCE, advance
from linear_motor import LinearMotor
from parameter_sets import SETS
from quarter_car import QuarterCar
from roads import IsoProfile, Road, splitmix64
from stimulus import inputs_at

LIFT_OFF = {"tire.lift_off": True}


def linear_matrices(p):
    """A and B of the linear quarter car in positions and velocities."""
    ms, mu = p["sprung_mass"], p["unsprung_mass"]
    k, d, kt, dt = p["strut.stiffness"], p["strut.damping"], p["tire.stiffness"], p["tire.damping"]
    a = np.array([[0, 1, 0, 0], [-k / ms, -d / ms, k / ms, d / ms],
                  [0, 0, 0, 1], [k / mu, d / mu, -(k + kt) / mu, -(d + dt) / mu]])
    b = np.array([[0, 0, 0], [0, 0, 1 / ms], [0, 0, 0], [kt / mu, dt / mu, -1 / mu]])
    return a, b


def exact_linear(case, rows):
    """Largest relative difference of a linear case's states from its exact solution, or None."""
    p = case["parameters"]
    if p["tire.quadratic"] or p["strut.coulomb.force"]:
        return None
    a, b = linear_matrices(p)
    step = expm(np.block([[a, b], [np.zeros((3, 7))]]) * case["step"])
    x, exact = np.array([case["start"][n] for n in QuarterCar.states]), []
    for k in range(round(case["stop"] / case["step"]) + 1):
        if k % case["rows_every"] == 0:
            exact.append(x)
        values = inputs_at(case, k * case["step"])
        x = step[:4, :4] @ x + step[:4, 4:] @ np.array([values[n] for n in QuarterCar.inputs])
    exact = np.array(exact)
    return float((np.abs(np.array(rows)[:, 1:5] - exact).max(axis=0) / np.abs(exact).max(axis=0)).max())


def run(model, state, u, stop, step=0.01):
    states = [list(state)]
    for k in range(round(stop / step)):
        states.append(advance(model, k * step, (k + 1) * step, states[-1], lambda _t: u, REFERENCE))
    return states


def complaints():
    return rig_complaints() + motor_complaints() + road_complaints()


def rig_complaints():
    found = []
    for name, p in SETS.items():
        car = QuarterCar(p, LIFT_OFF)
        if any(car.derivative([0.0] * 4, [0.0] * 3, car.mode([0.0] * 4, [0.0] * 3))):
            found.append(f"{name}: the origin is not an equilibrium")
        # Free motion from a raised body: undamped sets keep their energy, others only lose it.
        free = QuarterCar(p)
        size = 0.005 if p["sprung_mass"] > 10.0 else 0.001
        energies = [free.energy(x) for x in run(free, [size, 0.1, -size / 2, -0.2], [0.0] * 3, 1.0)]
        if p["strut.damping"] == 0.0:
            if max(abs(e / energies[0] - 1.0) for e in energies) > 1e-10:
                found.append(f"{name}: undamped, but the energy changes")
        elif any(b > a * (1.0 + 1e-12) for a, b in zip(energies, energies[1:])):
            found.append(f"{name}: free motion gains energy")
    # A raised road lifts a frictionless rig by just as much; a constant force stretches the strut.
    p = SETS["quanser"]
    end = run(QuarterCar(p), [0.0] * 4, [0.01, 0.0, 3.0], 30.0, step=0.5)[-1]
    if max(abs(end[2] - 0.01), abs(end[0] - end[2] - 3.0 / p["strut.stiffness"]), abs(end[1])) > 1e-11:
        found.append("quanser: wrong rest position under a constant force on a raised road")
    # In the air the centre of mass falls with g, whatever the strut does.
    car = QuarterCar(SETS["tum-table-10"] | {"guide.coulomb.force": 0.0}, LIFT_OFF)
    x, u = [0.02, 0.3, 0.04, -0.4], [0.0, 0.0, 77.0]
    a = car.derivative(x, u, car.mode(x, u))
    if abs((car.ms * a[1] + car.mu * a[3]) / (car.ms + car.mu) + 9.80665) > 1e-12:
        found.append("tum-table-10: airborne, but not in free fall")
    # The tyre force never goes below minus the static load, and is continuous at lift-off.
    if abs(car.tire.force(car.tire.lift_off_compression, 0.0, "contact") + car.tire.static_load) > 1e-9:
        found.append("tum-table-10: the tyre force jumps at the lift-off point")
    return found


def motor_complaints():
    found, motor = [], LinearMotor()
    end = run(motor, [0.0] * 3, [2.0, 0.0], 0.2)[-1]
    if abs(motor.output(end, None, None)[0] / (2.0 * motor.static_gain) - 1.0) > 1e-10:
        found.append("motor: 2 V do not settle at twice the static gain")
    end = run(motor, [0.0] * 3, [10.0, 0.0], 6.0, step=0.02)[-1]
    if abs(motor.output(end, None, None)[0] / motor.continuous - 1.0) > 1e-6:
        found.append("motor: the I2t limiter does not settle at the continuous current")
    if end[2] > motor.capacity * (1.0 + 1e-9):
        found.append("motor: the I2t accumulator passes its capacity")
    return found


def road_complaints():
    found = []
    known = [6457827717110365317, 3203168211198807973, 9817491932198370423]
    if [value for value, _ in zip(splitmix64(1234567), known)] != known:
        found.append("SplitMix64 does not give its known sequence")
    found += velocity_complaints()
    for road_class in "ADH":
        profile = IsoProfile(road_class, seed=1)
        # With n_i the geometric mean, each harmonic carries exactly its band's integral of Gd.
        power = 0.5 * float(np.sum(profile.amplitudes**2))
        density = quad(lambda n: profile.roughness * (n / 0.1) ** -2, 0.011, 2.83, epsabs=0, epsrel=1e-12,
                       points=[0.1], limit=200)[0]
        if abs(power / density - 1.0) > 1e-10:
            found.append(f"ISO class {road_class}: power {power / density:.12f} of the density's")
        ratio = octave_ratios(profile)
        if max(abs(math.log(r)) for r in ratio) > math.log(1.03):
            found.append(f"ISO class {road_class}: octave densities off by {ratio}")
    return found


def velocity_complaints():
    """The velocity against a central difference, away from the pieces' ends."""
    from cases_of_time import ROADS
    found = []
    for case in ROADS:
        if case["fmu"] != "Road":
            continue
        road = Road(case["changed"], case["settings"])
        times = np.linspace(0.013, case["stop"] - 0.011, 173)
        h = 1e-6
        scale = max(abs(road(t)[1]) for t in times)
        for t in times:
            if any(abs(t - mark) < 2 * h for mark in road.breaks(case["stop"])):
                continue
            slope = (road(t + h)[0] - road(t - h)[0]) / (2.0 * h)
            if abs(slope - road(t)[1]) > 1e-7 * scale:
                found.append(f"{case['case']}: velocity is not the derivative at {t}")
                break
    return found


def octave_ratios(profile):
    """Estimated over nominal density in octave bands, from a sampled profile of 40 km."""
    spacing = 0.1
    s = np.arange(400_000) * spacing
    z = np.zeros_like(s)
    for a, w, phi in zip(profile.amplitudes, profile.wave_numbers, profile.phases):
        z += a * np.sin(w * s + phi)
    n, density = welch(z, fs=1.0 / spacing, nperseg=40_000, window="hann")
    ratios, low = [], 0.02
    while 2.0 * low < 2.8:
        inside = (n >= low) & (n < 2.0 * low)
        nominal = profile.roughness * 0.1**2 * (1.0 / low - 1.0 / (2.0 * low))
        ratios.append(float(np.sum(density[inside]) * (n[1] - n[0]) / nominal))
        low *= 2.0
    return ratios
