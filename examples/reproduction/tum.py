"""TUM quarter-vehicle test rig, report TRAC-5."""

import numpy as np
import tum_active
from measure import linearise, parameters, rms, stepped
from output import plt
from published import missing, taken
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
    yield Number("force of 10 V", "Table 3, peak; eq. 11", 3200.0, 10.0 * static, 1.0, "N", reason)


def limiter(fmus):
    """3.2.1: the exciter in force control, its rod held: it weighs a thousand tonnes."""
    start = {"drive": 2, "moving_mass": 1e6}
    return stepped(fmus, "TumExcitationMotor", "force", {"command.force": 3000.0}, 6.0, start=start)


def limits(fmus):
    forces = limiter(fmus)
    yield Number("excitation motor, peak force", "3.2.1", 1860.0, float(forces.max()), 0.6, "N")
    over = 1e-3 * float(np.count_nonzero(forces > 0.99 * 1860.0))
    yield Number("for how long", "3.2.1", 1.0, over, 0.03, "s")
    yield Number("force for ever", "3.2.1", 276.0, rms(forces[-2000:]), 0.6, "N")
    motor = stepped(fmus, "LinearMotor", "force", {"force_reference": 3200.0}, 6.0)
    yield Number("suspension actuator, continuous force", "Table 3", 800.0, float(motor[-1]), 0.6, "N")


def masses(fmus):
    for name, table, *_ in MODES:
        found = parameters(fmus, name)
        total = 118.3 if table == "Table 10" else 113.48
        yield Number("total mass", table, total, found["sprung_mass"] + found["unsprung_mass"], 0.006, "kg")


def benches(fmus):
    """4.3: strut and tyre alone, their lower end moved."""

    def force(name, position, velocity):
        start = {"motion.position": position, "motion.velocity": velocity}
        return parameters(fmus, name, start)["force"]

    # The damper's share at 2 mm/s is 1.5 N.
    friction = 0.5 * (force("TumStrutDyno", 0.01, 2e-3) - force("TumStrutDyno", 0.01, -2e-3))
    yield Number("strut, half the hysteresis at 2 mm/s", "4.3.1", 94.0, friction, 2.0, "N")
    for what, sign, printed in (("compression", 1.0, 521.0), ("rebound", -1.0, 994.0)):
        rate = sign * (force("TumStrutDyno", 0.0, sign * 0.5) - force("TumStrutDyno", 0.0, sign * 0.4)) / 0.1
        yield Number(f"strut, damping in {what}", "Table 9, measured", printed, rate, 0.6, "N s/m")
    mean = parameters(fmus, "TumStrutDyno")["strut.damping"]
    yield Number("strut, mean of both", "Table 9, measured", 758.0, mean, 0.6, "N s/m")
    rate = (force("TumTireDyno", 1e-5, 0.0) - force("TumTireDyno", -1e-5, 0.0)) / 2e-5
    reason = "a and b of Table 7, measured, have it 0.316 mm beyond their origin, the operating point"
    yield Number("tyre, rate at the operating point", "4.3.2", 152186.0, rate, 0.6, "N/m", reason)
    rate = (force("TumTireDyno", 0.326e-3, 0.0) - force("TumTireDyno", 0.306e-3, 0.0)) / 2e-5
    yield Number("tyre, rate 0.316 mm beyond it", "4.3.2", 152186.0, rate, 6.0, "N/m")


def noise(fmus):
    """Tables 4 and 5: the sensors, drives off and on."""
    found = parameters(fmus, "TumSensorChain")
    for bits, channel, printed in ((16, "body_acceleration", 0.3), (12, "wheel_acceleration", 4.9)):
        resolution = 1e3 * found[f"{channel}.converter.resolution"]
        yield Number(f"resolution of the {bits}-bit converter", "Table 4", printed, resolution, 0.06, "mV")
    for name, decibels, peak, within in (
        ("body.acceleration", 70.0, 40.0, 1.1),
        ("wheel.acceleration", 65.0, 40.0, 1.1),
        ("wheel.force", 75.0, 50.0, 1.1),
        ("actuator.current", None, 100.0, 6.0),
    ):
        what, channel = name.replace(".", " "), name.replace(".", "_")
        if decibels is not None:
            sine = found[f"{channel}.sensor.full_scale"] / np.sqrt(2)
            ratio = 20 * np.log10(sine / rms(error(fmus, "TumSensorChain", name)))
            yield Number(f"{what}, signal-to-noise ratio of full scale", "Table 5", decibels, ratio, 0.6, "dB")
        # Mean of what each second shows.
        live = 1e3 * float(np.mean(np.ptp(error(fmus, "TumLiveSensorChain", name).reshape(-1, 1000), axis=1)))
        yield Number(f"{what}, peak to peak of a second, drives on", "Table 5", peak, live, within, "mV")


def error(fmus, name, signal):
    """In volts, over 10 s of a slow ramp that passes twenty steps of the converter."""
    found, channel = parameters(fmus, name), signal.replace(".", "_")
    volts = found[f"{channel}.sensitivity"]
    slope = 2 * found[f"{channel}.converter.resolution"] / volts
    samples = volts * stepped(fmus, name, f"measured.{signal}", {signal: lambda time: slope * time}, 10.1)[100:]
    time = np.arange(len(samples))
    # What the filters are late is no noise.
    return samples - np.polyval(np.polyfit(time, samples, 1), time)


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
    sources = (masses, modes, benches, motor, limits, noise)
    numbers = [number for source in sources for number in source(fmus)]
    given = list(taken(fmus, "tum")), list(missing("tum"))
    return Section("TUM: quarter-vehicle test rig", numbers, [claim], figures, *given)
