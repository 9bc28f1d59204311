"""A car at 70 km/h on a rough road: passive with soft and with hard valves, and active.

    python full_car.py [--fmus FOLDER] [--out FOLDER]

Road, car and four pump actuators are six FMUs, with the modal skyhook and a force controller at each actuator
eleven. Ajala drove these three configurations over a test track; the picture is that of the paper's Fig. 8, from
a random road and an assumed car. On a common scale: the paper normalises its figure and says nothing of how.
"""

import numpy as np
from jacobi import System
from output import folders, plt, save

CORNERS = ["front_left", "front_right", "rear_left", "rear_right"]
MOTIONS = {"heave": "m/s²", "roll": "rad/s²", "pitch": "rad/s²"}
SIGNALS = [f"car.{motion}.acceleration" for motion in MOTIONS]
STEP, STOP, ROAD_START = 1e-3, 40.5, 0.5
# In Hz: the body's modes, the frequencies to which people are sensitive, and the wheels' modes.
BANDS = {"below 2 Hz": (0.5, 2.0), "2 to 8 Hz": (2.0, 8.0), "above 8 Hz": (8.0, 30.0)}


def passive(actuator):
    """Road, car and four actuators whose pumps are locked."""
    components = {"road": "AjalaRoad", "car": "AjalaFullCar"}
    connections = []
    for corner in CORNERS:
        components[f"actuator_{corner}"] = actuator
        connections += [
            (f"road.{corner}.position", f"car.road.{corner}.position"),
            (f"road.{corner}.velocity", f"car.road.{corner}.velocity"),
            (f"car.suspension.{corner}.velocity", f"actuator_{corner}.suspension.velocity"),
            (f"actuator_{corner}.force", f"car.actuator.{corner}.force"),
        ]
    return components, connections


def active():
    """The same with soft valves, a force controller at each pump and the modal skyhook above them."""
    components, connections = passive("AjalaSoftPumpHydraulicActuator")
    components["controller"] = "AjalaModalSkyhook"
    connections += [
        ("car.heave.velocity", "controller.heave.velocity"),
        ("car.roll.speed", "controller.roll.speed"),
        ("car.pitch.speed", "controller.pitch.speed"),
    ]
    for corner in CORNERS:
        force, actuator = f"force_{corner}", f"actuator_{corner}"
        components[force] = "AjalaForceTwoDofLpv"
        connections += [
            (f"controller.{corner}.force", f"{force}.force_reference"),
            (f"car.suspension.{corner}.deflection", f"{force}.suspension.deflection"),
            (f"car.suspension.{corner}.velocity", f"{force}.suspension.velocity"),
            (f"{actuator}.force", f"{force}.actuator.force"),
            (f"{actuator}.motor.speed", f"{force}.motor.speed"),
            (f"{actuator}.pressure.compression", f"{force}.pressure.compression"),
            (f"{actuator}.pressure.rebound", f"{force}.pressure.rebound"),
            (f"{force}.motor.torque", f"{actuator}.motor.torque"),
        ]
    return components, connections


SYSTEMS = {
    "full-car-passive-soft": passive("AjalaPassiveSoftPumpHydraulicActuator"),
    "full-car-passive-hard": passive("AjalaPassiveHardPumpHydraulicActuator"),
    "full-car-modal-skyhook": active(),
}
LABELS = {"full-car-passive-soft": "soft", "full-car-passive-hard": "hard", "full-car-modal-skyhook": "active"}


def simulate(folder, name, signals=SIGNALS, parameters=None):
    components, connections = SYSTEMS[name]
    with System(folder, components, connections, parameters) as system:
        return system.run(STOP, STEP, signals)


def spectrum(values):
    """Power spectral density, averaged over windows of 8 s."""
    length = round(8.0 / STEP)
    window = np.hanning(length)
    parts = [values[i : i + length] * window for i in range(0, len(values) - length + 1, length // 2)]
    power = np.mean([np.abs(np.fft.rfft(part)) ** 2 for part in parts], axis=0)
    return np.fft.rfftfreq(length, STEP), 2 * STEP * power / np.sum(window**2)


def spectra(result):
    """Of the body's accelerations, from the start of the road."""
    rough = result["time"] > ROAD_START
    return {motion: spectrum(result[f"car.{motion}.acceleration"][rough]) for motion in MOTIONS}


def rms(density, band):
    """What a density has in a band."""
    frequency, power = density
    inside = (frequency >= band[0]) & (frequency < band[1])
    return np.sqrt(np.sum(power[inside]) * frequency[1])


def bands(result):
    """Effective accelerations {motion: {band: value}}."""
    densities = spectra(result)
    return {motion: {name: rms(densities[motion], band) for name, band in BANDS.items()} for motion in MOTIONS}


def report(results):
    measured = {LABELS[name]: bands(result) for name, result in results.items()}
    print(f"{'RMS acceleration':<32}" + "".join(f"{label:>10}" for label in measured))
    for motion, unit in MOTIONS.items():
        for band in BANDS:
            row = "".join(f"{values[motion][band]:>10.4f}" for values in measured.values())
            print(f"{f'{motion}, {band}, in {unit}':<32}{row}")


def plot(results):
    figure, axes = plt.subplots(1, 3, figsize=(10, 3.6), layout="constrained")
    style = {
        "soft": {"color": "0.6", "linewidth": 2.2},
        "hard": {"color": "black", "linewidth": 1.0, "linestyle": "--"},
        "active": {"color": "tab:blue", "linewidth": 1.4},
    }
    for panel, (motion, unit) in zip(axes, MOTIONS.items()):
        for name, result in results.items():
            label = LABELS[name]
            frequency, power = spectra(result)[motion]
            shown = (frequency >= 0.4) & (frequency <= 30)
            panel.loglog(frequency[shown], power[shown], label=label, **style[label])
        panel.set(title=motion, xlabel="frequency in Hz", xlim=(0.4, 30))
        panel.set_ylabel(f"acceleration in ({unit})²/Hz")
        panel.set_xticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"])
        panel.minorticks_off()
    axes[0].legend(loc="lower left")
    return figure


def main():
    fmus, out = folders(__doc__)
    results = {name: simulate(fmus, name) for name in SYSTEMS}
    report(results)
    save(plot(results), out / "full_car.png")


if __name__ == "__main__":
    main()
