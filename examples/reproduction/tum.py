"""TUM quarter-vehicle test rig, report TRAC-5."""

import numpy as np
import tum_active
from jacobi import Component
from measure import linearise, parameters
from output import plt
from sheet import Claim, Figure, Number, Section
from ssp import open_system

# FMU, table, and printed chassis frequency and ratio, wheel frequency and ratio.
MODES = [
    ("TumTable7OptimisedQuarterVehicle", "Table 7, optimised", 1.49, 0.47, 12.92, 0.212),
    ("TumTable7MeasuredQuarterVehicle", "Table 7, measured", 1.51, 0.443, 12.59, 0.196),
    ("TumLinearOptimisedQuarterCar", "Table 9, optimised", 1.39, 0.723, 14.24, 0.284),
    ("TumLinearMeasuredQuarterCar", "Table 9, measured", 1.51, 0.447, 12.59, 0.198),
    ("TumQuarterVehicle", "Table 10", 1.5, 0.397, 12.7, 0.18),
]
REASONS = {
    ("Table 7, optimised", "wheel frequency"): "with strut and tyre rate together it is 12.93 Hz; all other tables "
    "take the tyre alone",
    ("Table 7, optimised", "wheel damping ratio"): "0.222 goes with the chassis ratio 0.47 of the same damper",
    ("Table 7, measured", "chassis frequency"): "the printed spring and mass make 1.528 Hz",
    ("Table 9, measured", "chassis frequency"): "the printed spring and mass make 1.528 Hz",
    ("Table 9, measured", "chassis damping ratio"): "the printed 758 N s/m make 0.441; 0.447 belongs to 769 N s/m",
    ("Table 9, measured", "wheel damping ratio"): "the printed 758 N s/m make 0.195; 0.198 belongs to 769 N s/m",
}


def modes(fmus):
    for name, table, *printed in MODES:
        found = parameters(fmus, name)
        for what, variable, value, within, unit in zip(
            ["chassis frequency", "chassis damping ratio", "wheel frequency", "wheel damping ratio"],
            ["body.natural_frequency", "body.damping_ratio", "wheel.natural_frequency", "wheel.damping_ratio"],
            printed,
            [0.006, 0.0006, 0.011, 0.0006],
            ["Hz", "", "Hz", ""],
            strict=True,
        ):
            yield Number(what, table, value, found[variable], within, unit, REASONS.get((table, what), ""))


def motor_bode(fmus):
    frequencies = np.geomspace(1.0, 200.0, 2000)
    motor = linearise(fmus, "LinearMotor", ["voltage"], ["force"])
    return frequencies, parameters(fmus, "LinearMotor")["force_gain"], motor.response(frequencies)[:, 0, 0]


def motor(fmus):
    frequencies, static, gain = motor_bode(fmus)
    decibels = 20 * np.log10(np.abs(gain) / static)
    edge = float(np.interp(3.0, -decibels, frequencies))
    yield Number("actuator bandwidth (−3 dB)", "4.2", 28.6, edge, 0.06, "Hz")
    reason = "10 V make 3178 N with 100 N/A, the printed 1 A ~ 1 kN would make 31.8 kN"
    yield Number("force of 10 V", "Table 3, peak", 3200.0, 10.0 * static, 1.0, "N", reason)


def limiter(fmus):
    """3.2.1: the exciter's force with its rod held, the drive in force control, for 6 s."""
    exciter = Component("exciter", fmus / "TumExcitationMotor.fmu")
    # The drive's choice of force control; a rod of a thousand tonnes is held.
    for name, value in {"drive": 2, "moving_mass": 1e6}.items():
        exciter.set(name, value)
    exciter.fmu.setupExperiment(startTime=0.0)
    exciter.fmu.enterInitializationMode()
    exciter.fmu.exitInitializationMode()
    exciter.set("command.force", 3000.0)
    (force,) = exciter.references(["force"])
    forces = []
    for index in range(6000):
        exciter.fmu.doStep(currentCommunicationPoint=1e-3 * index, communicationStepSize=1e-3)
        forces.append(exciter.fmu.getReal([force])[0])
    exciter.close(failed=False)
    return np.array(forces)


def exciter(fmus):
    forces = limiter(fmus)
    yield Number("excitation motor, peak force", "3.2.1", 1860.0, float(forces.max()), 0.6, "N")
    over = 1e-3 * float(np.count_nonzero(forces > 0.99 * 1860.0))
    yield Number("for how long", "3.2.1", 1.0, over, 0.03, "s")
    yield Number("force for ever", "3.2.1", 276.0, float(np.sqrt(np.mean(forces[-2000:] ** 2))), 0.6, "N")


def draw_limiter(fmus):
    figure, axes = plt.subplots(figsize=(8, 2.8), layout="constrained")
    axes.plot(np.arange(1, 6001) * 1e-3, limiter(fmus))
    axes.set(xlabel="time in s", ylabel="force in N", xlim=(0, 6), ylim=(0, 2000))
    return figure


def draw_rig(result):
    figure, (road, sensed) = plt.subplots(2, 1, sharex=True, figsize=(9, 4.6), layout="constrained")
    time = result["time"]
    for name, label in {"road.position": "road that is wanted", "exciter.position": "plate", "rig.body.position": "body"}.items():
        road.plot(time, 1e3 * result[name], linewidth=1, label=label)
    road.set_ylabel("position in mm")
    road.legend(loc="upper left", ncols=3)
    sensed.plot(time, result["sensors.measured.body.acceleration"], linewidth=0.6, label="as measured")
    sensed.plot(time, result["rig.body.acceleration"], linewidth=0.6, label="as it is")
    sensed.set(xlabel="time in s", ylabel="body acceleration\nin m/s²", xlim=(0, 5))
    sensed.legend(loc="upper left", ncols=2)
    return figure


def draw_bode(fmus):
    frequencies, static, gain = motor_bode(fmus)
    figure, (size, phase) = plt.subplots(2, 1, sharex=True, figsize=(8, 4.6), layout="constrained")
    size.semilogx(frequencies, 20 * np.log10(np.abs(gain) / static))
    size.axhline(-3.0, color="0.5", linewidth=0.8, linestyle="--")
    size.set(ylabel="gain in dB", ylim=(-40, 3))
    phase.semilogx(frequencies, np.degrees(np.unwrap(np.angle(gain))))
    phase.set(xlabel="frequency in Hz", ylabel="phase in °", xlim=(1, 200))
    return figure


def section(fmus):
    with open_system(fmus, "tum-rig") as system:
        signals = ["road.position", "exciter.position", "rig.body.position", "rig.body.acceleration"]
        rig = system.run(5.0, 1e-3, [*signals, "sensors.measured.body.acceleration"])
    results = {
        "passive": tum_active.simulate(fmus, {"controller.damping": 0.0}),
        "Skyhook": tum_active.simulate(fmus),
    }
    passive, active = (tum_active.measure(result) for result in results.values())
    what = "RMS body velocity in mm/s"
    claim = Claim(
        "an active suspension takes motion from the body",
        "1",
        f"RMS velocity {active[what]:.1f} mm/s instead of {passive[what]:.1f} mm/s on a rough road",
        active[what] < 0.8 * passive[what],
    )
    figures = [
        Figure("linear-motor.png", "Frequency response of the suspension actuator (TUM Fig. 12)", lambda: draw_bode(fmus)),
        Figure("excitation-motor.png", "The excitation motor asked for 3 kN: I²t (TUM eq. 1)", lambda: draw_limiter(fmus)),
        Figure("tum-rig.png", "The whole rig: exciter, sensors, estimator, Skyhook", lambda: draw_rig(rig)),
        Figure("tum-active.png", "The rig on a rough road, passive and under Skyhook", lambda: tum_active.plot(results)),
    ]
    return Section("TUM: quarter-vehicle test rig", [*modes(fmus), *motor(fmus), *exciter(fmus)], [claim], figures)
