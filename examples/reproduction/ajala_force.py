"""Ajala's force control alone: the closed loops of Fig. 2b and the actuator on a rig, Fig. 6."""

import math

import numpy as np
from jacobi import System
from measure import rms
from output import plt
from sheet import Claim
from spectra import LINES, PERIOD, STEP, lines_of, multisine

CONTROLLERS = {"PID-H": "AjalaPidHForcePid", "PID-L": "AjalaPidLForcePid"}
# Frequency in Hz and amplitude: of the force that is wanted in N, and of the deflection in m. A body that rolls and
# heaves, a wheel that hops; no two frequencies are the same, so that the force tells them apart.
WANTED = [(0.5, 400.0), (1.3, 250.0)]
DEFLECTION = [(0.3, 0.02), (1.1, 0.015), (12.0, 0.004)]
SETTLING = 30.0


def closed_loop(fmus, controller):
    """Complex gain from the wanted force to the force, the piston held, line by line (eq. 29)."""
    components = {"controller": controller, "actuator": "AjalaPumpHydraulicActuatorLinear"}
    connections = [
        ("actuator.force", "controller.actuator.force"),
        ("controller.motor.torque", "actuator.motor.torque"),
    ]
    time, wanted, _ = multisine()
    # Millimetres of a road become hundreds of newtons, far from the limit of 3.9 kN.
    wanted = 1e5 * wanted
    forces = []
    with System(fmus, components, connections) as system:
        own = system.components["controller"]
        references = own.references(["force_reference"])
        system.initialize()
        for index in range(4 * len(time)):
            own.fmu.setReal(references, [wanted[index % len(time)]])
            system.step(index * STEP, STEP)
            forces.append(system.read({"actuator": ["force"]})["actuator.force"])
    return lines_of(np.array(forces[-len(time) :]), time) / lines_of(wanted, time)


def loop_claims(loops):
    high, low = (np.abs(loops[name]) for name in CONTROLLERS)

    def at(gain, frequency):
        return float(np.interp(frequency, LINES, gain))

    yield Claim(
        "PID-H tracks the force beyond the wheel's mode, without a resonance",
        "3.1, Fig. 2b",
        f"largest gain {high.max():.2f}, {at(high, 14.0):.2f} at 14 Hz",
        high.max() < 1.05 and at(high, 14.0) > 0.8,
    )
    peak = float(LINES[np.argmax(low)])
    yield Claim(
        "PID-L has a small resonance, and its bandwidth ends below the wheel's mode",
        "3.1, Fig. 2b",
        f"gain {low.max():.2f} at {peak:.1f} Hz, {at(low, 14.0):.2f} at 14 Hz",
        1.1 < low.max() < 2.0 and 2.5 < peak < 3.5 and at(low, 14.0) < 0.5,
    )
    errors = [abs(at(gain, 2.0) - 1.0) for gain in (high, low)]
    yield Claim(
        "even at low frequencies PID-L tracks worse",
        "3.1, Fig. 2b",
        f"{100 * errors[1]:.0f} % instead of {100 * errors[0]:.0f} % off at 2 Hz",
        errors[1] > 3.0 * errors[0],
    )


def sines(parts, time):
    return sum(amplitude * math.sin(math.tau * frequency * time) for frequency, amplitude in parts)


def rates(parts, time):
    return sum(a * math.tau * f * math.cos(math.tau * f * time) for f, a in parts)


def on_the_rig(fmus, locked):
    """Force over one period of wanted force and deflection, the pump free or locked."""
    components = {"controller": "AjalaForceTwoDofLpv", "actuator": "AjalaSoftPumpHydraulicActuator"}
    shared = ["actuator.force", "motor.speed", "pressure.compression", "pressure.rebound"]
    connections = [(f"actuator.{name.removeprefix('actuator.')}", f"controller.{name}") for name in shared]
    connections.append(("controller.motor.torque", "actuator.motor.torque"))
    forces = []
    with System(fmus, components, connections, {"actuator.pump.locked": locked}) as system:
        controller, actuator = system.components["controller"], system.components["actuator"]
        told = controller.references(["force_reference", "suspension.deflection", "suspension.velocity"])
        moved = actuator.references(["suspension.velocity"])
        system.initialize()
        for index in range(round((SETTLING + PERIOD) / STEP)):
            time = index * STEP
            controller.fmu.setReal(told, [sines(WANTED, time), sines(DEFLECTION, time), rates(DEFLECTION, time)])
            # The piston moves by what is in the middle of the step.
            actuator.fmu.setReal(moved, [rates(DEFLECTION, time + 0.5 * STEP)])
            system.step(time, STEP)
            forces.append(system.read({"actuator": ["force"]})["actuator.force"])
    time = np.arange(1, round(PERIOD / STEP) + 1) * STEP
    return {"time": time, "wanted": np.array([sines(WANTED, t) for t in time]), "force": np.array(forces[-len(time) :])}


def slow(record):
    """What is below 3 Hz."""
    spectrum = np.fft.rfft(record)
    spectrum[round(3.0 * PERIOD) + 1 :] = 0.0
    return np.fft.irfft(spectrum, len(record))


def rig_claims(records):
    passive, active = (records[name] for name in ("passive", "controlled"))
    off = {name: rms(slow(record["force"] - record["wanted"])) for name, record in records.items()}
    yield Claim(
        "the controlled actuator follows the low frequencies of the reference",
        "4, Fig. 6",
        f"{off['controlled']:.0f} N RMS off below 3 Hz, the passive one {off['passive']:.0f} N",
        off["controlled"] < 0.15 * off["passive"],
    )
    hop = [abs(np.fft.rfft(record["force"])[round(12.0 * PERIOD)]) for record in (active, passive)]
    yield Claim(
        "high frequencies are almost those of the passive damper",
        "4, Fig. 6",
        f"{hop[0] / hop[1]:.2f} × passive at the 12 Hz of the wheel",
        abs(hop[0] / hop[1] - 1.0) < 0.05,
    )


def draw_loops(loops):
    figure, axes = plt.subplots(figsize=(6.5, 3.6), layout="constrained")
    for (label, gain), line in zip(loops.items(), ["-", "--"], strict=True):
        axes.semilogx(LINES, 20 * np.log10(np.abs(gain)), "k", linestyle=line, label=label)
    axes.set(xlabel="frequency in Hz", ylabel="force over wanted force in dB", xlim=(0.3, 25), ylim=(-30, 10))
    axes.set_xticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"])
    axes.minorticks_off()
    axes.legend(loc="lower left")
    return figure


def draw_records(records):
    figure, panels = plt.subplots(2, 1, sharex=True, sharey=True, figsize=(9, 5), layout="constrained")
    for panel, (label, record) in zip(panels, records.items(), strict=True):
        panel.plot(record["time"], record["force"], color="0.65", linewidth=0.8, label="measured")
        panel.plot(record["time"], record["wanted"], color="black", linewidth=1.2, label="wanted")
        panel.set_ylabel(f"force in N, {label}")
    panels[0].legend(loc="upper right", ncols=2)
    panels[1].set(xlabel="time in s", xlim=(0, PERIOD))
    return figure
