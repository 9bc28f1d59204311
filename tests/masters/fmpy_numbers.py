"""The published numbers, read off the FMUs.

    python fmpy_numbers.py FOLDER
"""

import math
import sys
from pathlib import Path

import numpy as np
from rig import Fmu

ROWS = []


def expect(what, source, printed, found, tolerance):
    """Notes a number; it must be within a tolerance of the printed one."""
    ROWS.append((what, source, printed, found))
    assert abs(found - printed) <= tolerance, f"{what}: printed {printed}, found {found}"


def initial(folder, name, start=None):
    """Reads variables of an initialised FMU."""
    fmu = Fmu(folder / f"{name}.fmu")
    with fmu.running(start=start) as instance:
        values = {v.name: instance.getReal([v.valueReference])[0] for v in fmu.real}
    fmu.close()
    return values


def lqr(folder):
    """Quanser 3.1.1: K belongs to K_us = 2500 N/m; Table 3.1's 1250 N/m gives another one (E1)."""
    printed = {"suspension_deflection": 24.66, "body_velocity": 48.87, "tire_deflection": -0.47, "wheel_velocity": 3.68}
    found = initial(folder, "QuanserLqrController")
    for name, value in printed.items():
        # The sources cut digits off instead of rounding (3.6846 is printed 3.68).
        expect(f"LQR gain, {name.replace('_', ' ')}", "Quanser 3.1.1", value, found[f"gain.{name}"], 0.006)
    table = initial(folder, "QuanserLqrController", {"tire.stiffness": 1250.0})
    with_table = {"suspension_deflection": 24.66, "body_velocity": 47.61, "tire_deflection": 38.74, "wheel_velocity": 4.51}
    for name, value in with_table.items():
        expect(f"LQR gain with Table 3.1's tyre, {name.replace('_', ' ')}", "not printed", value, table[f"gain.{name}"], 0.006)


def frequencies(folder):
    """TUM Tables 7, 9 and 10: uncoupled modes. Those that do not come out are findings and stand in the notes."""
    for name, source, body, body_ratio, wheel, wheel_ratio in [
        ("TumLinearOptimisedQuarterCar", "TUM Table 9, optimised", 1.39, 0.723, 14.24, 0.284),
        ("TumTable7OptimisedQuarterVehicle", "TUM Table 7, optimised", 1.49, 0.47, None, None),
        ("TumTable7MeasuredQuarterVehicle", "TUM Table 7, measured", None, 0.443, 12.59, 0.196),
        ("TumQuarterVehicle", "TUM Table 10", 1.5, 0.397, 12.7, 0.18),
    ]:
        found = initial(folder, name)
        for what, printed, tolerance in [
            ("body.natural_frequency", body, 0.006),
            ("body.damping_ratio", body_ratio, 0.0006),
            ("wheel.natural_frequency", wheel, 0.011),
            ("wheel.damping_ratio", wheel_ratio, 0.0006),
        ]:
            if printed is not None:
                expect(what.replace(".", " ").replace("_", " "), source, printed, found[what], tolerance)


def coupled(folder, name):
    """Undamped frequencies of an FMU about its start: eigenvalues of the directional derivatives of model exchange."""
    from fmpy.fmi2 import FMU2Model

    fmu = Fmu(folder / f"{name}.fmu")
    states, rates = [v.valueReference for v in fmu.states], [v.valueReference for v in fmu.rates]
    with fmu.running(FMU2Model) as instance:
        instance.enterContinuousTimeMode()
        columns = [instance.getDirectionalDerivative(rates, [state], [1.0]) for state in states]
    fmu.close()
    # States of effects that are off do not move.
    return sorted({round(abs(value) / math.tau, 6) for value in np.linalg.eigvals(np.array(columns).T)} - {0.0})


def modes(folder):
    """Coupled modes of the linear rigs."""
    for name, frequencies in [("QuanserQuarterCar", (2.579, 9.411)), ("TumLinearOptimisedQuarterCar", (1.420, 13.924))]:
        for printed, frequency in zip(frequencies, coupled(folder, name)):
            expect("coupled natural frequency", f"{name}, from tests/reference/numbers.json", printed, frequency, 0.001)


def semi_active_rig(folder):
    """Kogut 3.1.2, 3.2.2: where the arms rest, and between which excitations the body's resonance lies."""
    rig, locked = initial(folder, "KogutSasRig"), initial(folder, "KogutLockedSasRig")
    expect("wheel arm at rest in rad", "Kogut 3.2.2", -0.195, rig["rest.wheel_arm_angle"], 0.0005)
    # 1.1 mrad off: the printed parameters are rounded.
    expect("body arm at rest in rad", "Kogut 3.2.2", 0.354, rig["rest.body_arm_angle"], 0.0012)
    expect("body arm at rest, wheel arm locked, in rad", "Kogut 3.1.2", 0.57, locked["rest.body_arm_angle"], 0.0002)
    # The body swings up at 1.35 Hz (Fig. 3) and is damped at 1.6 Hz (Figs. 15-17): the resonance is between.
    body = coupled(folder, "KogutSasRig")[0]
    expect("body's resonance in Hz", "Kogut, between Fig. 3 and Fig. 15", (1.35 + 1.6) / 2.0, body, 0.125)
    brake = initial(folder, "KogutMrRotaryBrake")
    expect("brake without current in N.m.s/rad", "Kogut Table 1: b(0) I", 0.1921 * 1.37, brake["damping"], 0.0001)


def bandwidth(folder):
    """TUM 4.2: the motor's force falls to -3 dB at 28.6 Hz, measured by sines on the FMU."""
    fmu = Fmu(folder / "LinearMotor.fmu")
    (voltage,), (force,) = fmu.reference("voltage"), fmu.reference("force")

    def gain(frequency):
        # Inputs with their exact derivatives: the sine is the one meant, not a staircase.
        omega, step, size = math.tau * frequency, 2.5e-4, 1.0
        correlation, count = 0.0, 0
        with fmu.running() as instance:
            # Whole periods, after half a second of transients.
            first, last = round(0.5 / step), round((0.5 + math.floor(2.0 * frequency) / frequency) / step)
            for index in range(last):
                time = index * step
                instance.setReal([voltage], [size * math.sin(omega * time)])
                slopes = [size * omega * math.cos(omega * time), -size * omega**2 * math.sin(omega * time)]
                instance.setRealInputDerivatives([voltage, voltage], [1, 2], slopes)
                instance.doStep(currentCommunicationPoint=time, communicationStepSize=step)
                if index + 1 > first:
                    turn = omega * (index + 1) * step
                    correlation += instance.getReal([force])[0] * complex(math.cos(turn), -math.sin(turn))
                    count += 1
        return 2.0 * abs(correlation) / count / size

    static = initial(folder, "LinearMotor")["force_gain"]
    expect("static force gain in N/V", "TUM eq. 10-11, 100 N/A (E4)", 317.8, static, 0.06)
    tried = np.array([27.6, 28.2, 28.8, 29.4])
    decibels = 20.0 * np.log10([gain(frequency) / static for frequency in tried])
    expect("motor bandwidth (-3 dB) in Hz", "TUM 4.2", 28.6, float(np.interp(3.0, -decibels, tried)), 0.3)
    fmu.close()


def excitation_motor(folder):
    """TUM 3.2.1: 1860 N for 1 s, then 276 N; its rod is held, the drive controls the force."""
    fmu = Fmu(folder / "TumExcitationMotor.fmu")
    (command,), (force,) = fmu.reference("command.force"), fmu.reference("force")
    forces = []
    with fmu.running(start={"drive": 2, "moving_mass": 1e9}) as instance:
        instance.setReal([command], [3000.0])
        for index in range(6000):
            instance.doStep(currentCommunicationPoint=1e-3 * index, communicationStepSize=1e-3)
            forces.append(instance.getReal([force])[0])
    fmu.close()
    # Half a unit of the last printed digit: the current loop overshoots by 0.3 N.
    expect("excitation motor: peak force in N", "TUM 3.2.1", 1860.0, max(forces), 0.5)
    # The last 2 % of the second are the way down to the continuous force.
    expect("excitation motor: peak force lasts, in s", "TUM 3.2.1", 1.0, 1e-3 * np.sum(np.array(forces) > 1068.0), 0.02)
    expect("excitation motor: force for ever in N", "TUM 3.2.1", 276.0, forces[-1], 0.1)


def elements(folder):
    """TUM 4.3: what the strut's and the tyre's benches show."""
    strut, tire = (Fmu(folder / f"Tum{name}Dyno.fmu") for name in ("Strut", "Tire"))

    def bench(fmu, instance):
        def force(position, velocity):
            instance.setReal(fmu.reference("motion.position", "motion.velocity"), [position, velocity])
            return instance.getReal(fmu.reference("force"))[0]

        return force

    with strut.running() as instance:
        force = bench(strut, instance)
        # The damper's share at 2 mm/s is 1.5 N.
        friction = 0.5 * (force(0.01, 2e-3) - force(0.01, -2e-3))
        rates = [(force(0.0, sign * 0.5) - force(0.0, sign * 0.4)) / (sign * 0.1) for sign in (1, -1)]
    expect("strut: hysteresis at 2 mm/s in N", "TUM 4.3.1", 94.0, friction, 2.0)
    expect("strut: damping in compression in N.s/m", "TUM Table 9, measured", 521.0, rates[0], 0.5)
    expect("strut: damping in rebound in N.s/m", "TUM Table 9, measured", 994.0, rates[1], 0.5)
    with tire.running() as instance:
        force = bench(tire, instance)
        rate = (force(0.326e-3, 0.0) - force(0.306e-3, 0.0)) / 20e-6
    expect("tyre: rate 0.316 mm beyond its operating point in N/m", "TUM 4.3.2", 152186.0, rate, 5.0)
    strut.close(), tire.close()


def encoders(folder):
    """Kogut 2.1: the accuracy is one count."""
    fmu = Fmu(folder / "SasSensorChain.fmu")
    with fmu.running() as instance:
        instance.setReal(fmu.reference("eccentric.angle"), [0.0016])
        instance.doStep(currentCommunicationPoint=0.0, communicationStepSize=1e-3)
        angle = instance.getReal(fmu.reference("measured.eccentric.angle"))[0]
    fmu.close()
    expect("encoder: one count in rad", "Kogut 2.1", 0.001534, angle, 5e-7)


def main():
    folder = Path(sys.argv[1])
    for check in (lqr, frequencies, modes, bandwidth, semi_active_rig, excitation_motor, elements, encoders):
        check(folder)
    for what, source, printed, found in ROWS:
        print(f"{what:52} {printed:9.3f} {found:10.4f}  {source}")


if __name__ == "__main__":
    main()
