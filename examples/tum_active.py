"""The TUM quarter vehicle on a rough road: its linear motor idle, and following a Skyhook law.

    python tum_active.py [--fmus FOLDER] [--out FOLDER]

Road, rig, motor and controller are four FMUs. The motor has a current loop and limits of its own, the
rig a nonlinear strut and a wheel that may leave the road.
"""

import numpy as np
from jacobi import System
from output import folders, plt, save

COMPONENTS = {"road": "TumRoad", "rig": "TumQuarterVehicle", "controller": "TumSkyhook", "motor": "LinearMotor"}
CONNECTIONS = [
    ("road.position", "rig.road.position"),
    ("road.velocity", "rig.road.velocity"),
    ("rig.body.velocity", "controller.body.velocity"),
    ("controller.force", "motor.force_reference"),
    ("rig.suspension.deflection", "motor.suspension.deflection"),
    ("rig.suspension.velocity", "motor.suspension.velocity"),
    ("motor.force", "rig.actuator.force"),
]
SIGNALS = [
    "road.position", "rig.body.position", "rig.body.velocity", "rig.body.acceleration",
    "rig.suspension.deflection", "rig.wheel.force", "motor.force", "motor.current",
]  # fmt: skip
STEP, STOP, ROAD_START = 1e-3, 10.0, 0.5
# Weight of body and wheel in N. The dynamic wheel force counts from it: in the air it is minus this.
STATIC_LOAD = (94.38 + 23.92) * 9.80665


def simulate(folder, parameters=None):
    with System(folder, COMPONENTS, CONNECTIONS, parameters) as system:
        return system.run(STOP, STEP, SIGNALS)


def rms(values):
    return np.sqrt(np.mean(values**2))


def measure(result):
    """What a suspension is judged by: comfort, room and contact with the road; and the motor's effort."""
    airborne = result["rig.wheel.force"] < -STATIC_LOAD + 1e-3
    return {
        "RMS body velocity in mm/s": 1e3 * rms(result["rig.body.velocity"]),
        "RMS body acceleration in m/s2": rms(result["rig.body.acceleration"]),
        "largest deflection in mm": 1e3 * np.abs(result["rig.suspension.deflection"]).max(),
        "RMS wheel force in N": rms(result["rig.wheel.force"]),
        "off the road in % of the time": 100 * np.mean(airborne),
        "RMS motor force in N": rms(result["motor.force"]),
        "largest motor current in A": np.abs(result["motor.current"]).max(),
    }


def report(results):
    measured = {label: measure(result) for label, result in results.items()}
    print(f"{'':<32}" + "".join(f"{label:>10}" for label in measured))
    for name in next(iter(measured.values())):
        print(f"{name:<32}" + "".join(f"{rows[name]:>10.2f}" for rows in measured.values()))


def spectrum(values):
    """Power spectral density, averaged over windows of 2 s."""
    length = round(2.0 / STEP)
    window = np.hanning(length)
    parts = [values[i : i + length] * window for i in range(0, len(values) - length + 1, length // 2)]
    power = np.mean([np.abs(np.fft.rfft(part)) ** 2 for part in parts], axis=0)
    return np.fft.rfftfreq(length, STEP), 2 * STEP * power / np.sum(window**2)


def plot(results):
    figure, axes = plt.subplot_mosaic(
        [["position", "position"], ["spectrum", "force"]], figsize=(9, 6), height_ratios=(5, 4), layout="constrained"
    )
    style = {"passive": {"color": "0.5"}, "Skyhook": {"color": "tab:blue"}}
    active = results["Skyhook"]
    time = active["time"]
    position, density, force = axes["position"], axes["spectrum"], axes["force"]
    position.plot(time, 1e3 * active["road.position"], color="tab:brown", alpha=0.6, linewidth=0.7, label="road")
    for label, result in results.items():
        position.plot(time, 1e3 * result["rig.body.position"], linewidth=1.6, label=f"body, {label}", **style[label])
        rough = result["rig.body.acceleration"][time > ROAD_START]
        density.loglog(*spectrum(rough), linewidth=1.6, **style[label])
    position.set(xlabel="time in s", ylabel="position in mm", xlim=(0, STOP))
    position.legend(loc="upper left")
    density.set(xlabel="frequency in Hz", xlim=(0.5, 40), ylim=(1e-3, 10))
    density.set_xticks([0.5, 1, 2, 5, 10, 20, 40], ["0.5", "1", "2", "5", "10", "20", "40"])
    density.minorticks_off()
    density.set_ylabel("body acceleration\nin (m/s²)²/Hz")
    force.plot(time, active["motor.force"], color="tab:blue", linewidth=0.9)
    force.set(xlabel="time in s", ylabel="motor force in N", xlim=(0, STOP))
    return figure


def main():
    fmus, out = folders(__doc__)
    results = {"passive": simulate(fmus, {"controller.damping": 0.0}), "Skyhook": simulate(fmus)}
    report(results)
    save(plot(results), out / "tum_active.png")


if __name__ == "__main__":
    main()
