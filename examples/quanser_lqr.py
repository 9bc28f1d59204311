"""The Quanser Active Suspension on a square road: passive until 5 s, under its LQR afterwards.

    python quanser_lqr.py [--fmus FOLDER] [--out FOLDER]

The experiment of the Quanser laboratory guide, section 3.1: plate positions, body acceleration, and
how soon the body has settled after an edge of the road.
"""

import numpy as np
from jacobi import System
from output import folders, plt, save

COMPONENTS = {"road": "QuanserRoad", "rig": "QuanserQuarterCar", "controller": "QuanserLqrController"}
CONNECTIONS = [
    ("road.position", "rig.road.position"),
    ("road.velocity", "rig.road.velocity"),
    ("rig.suspension.deflection", "controller.suspension.deflection"),
    ("rig.body.velocity", "controller.body.velocity"),
    ("rig.tire.deflection", "controller.tire.deflection"),
    ("rig.wheel.velocity", "controller.wheel.velocity"),
    ("controller.force", "rig.actuator.force"),
]
SIGNALS = ["road.position", "rig.wheel.position", "rig.body.position", "rig.body.acceleration", "controller.force"]
STEP, STOP, SWITCH_ON = 1e-3, 10.0, 5.0

# On the guide's road of 0.3 Hz the passive body has not settled when the next edge comes. So settling is
# measured on a slower one, at two edges of equal height: the first passive, the second under the LQR.
SLOW, SLOW_EDGES = 0.1, {"open loop": 5.0, "LQR": 10.0}
# Settled: closer to the road's new height than this share of the edge, from then on.
BAND = 0.05


def simulate(folder, frequency=0.3, switch_on=SWITCH_ON, stop=STOP):
    parameters = {"road.frequency": frequency, "controller.switch_on_time": switch_on}
    with System(folder, COMPONENTS, CONNECTIONS, parameters) as system:
        return system.run(stop, STEP, SIGNALS)


def settling(result, edge, window):
    """How long after an edge of the road the body is still outside the band, within a window."""
    part = (result["time"] > edge - STEP / 2) & (result["time"] < edge + window - STEP / 2)
    height = result["road.position"][part][-1]
    jump = height - result["road.position"][result["time"] < edge - STEP / 2][-1]
    outside = np.abs(result["rig.body.position"][part] - height) > BAND * abs(jump)
    return result["time"][part][outside][-1] - edge


def measure_settling(folder):
    window = 0.5 / SLOW
    result = simulate(folder, SLOW, SLOW_EDGES["LQR"], SLOW_EDGES["LQR"] + window)
    return {label: settling(result, edge, window) for label, edge in SLOW_EDGES.items()}


def report(result, times):
    for label, time in times.items():
        print(f"{label:<10} settles within {100 * BAND:g} % in {time:.3f} s")
    active = result["time"] > SWITCH_ON + STEP / 2
    for label, part in (("in open loop", ~active), ("with LQR", active)):
        print(f"largest body acceleration: {np.abs(result['rig.body.acceleration'][part]).max():.3f} m/s2 {label}")
    print(f"largest force of the controller: {np.abs(result['controller.force']).max():.3f} N")


def plot(result, times):
    figure, (positions, acceleration) = plt.subplots(
        2, 1, sharex=True, figsize=(9, 5.4), height_ratios=(3, 2), layout="constrained"
    )
    time = result["time"]
    positions.plot(time, 1e3 * result["road.position"], color="0.55", label="road")
    positions.plot(time, 1e3 * result["rig.wheel.position"], color="tab:orange", linewidth=1, label="wheel")
    positions.plot(time, 1e3 * result["rig.body.position"], color="tab:blue", linewidth=1.8, label="body")
    positions.set_ylabel("position in mm")
    positions.legend(loc="lower left", ncols=3)
    acceleration.plot(time, result["rig.body.acceleration"], color="tab:blue", linewidth=1)
    acceleration.set_ylabel("body acceleration\nin m/s²")
    acceleration.set_xlabel("time in s")
    for axes in (positions, acceleration):
        axes.axvspan(SWITCH_ON, STOP, color="tab:green", alpha=0.08, linewidth=0)
        axes.set_xlim(0, STOP)
    positions.set_ylim(-42, 48)
    for label, middle in (("open loop", SWITCH_ON / 2), ("LQR", (SWITCH_ON + STOP) / 2)):
        text = f"{label}: body settles in {times[label]:.1f} s"
        positions.text(middle, 38, text, ha="center", va="bottom", fontsize=11)
    return figure


def main():
    fmus, out = folders(__doc__)
    result, times = simulate(fmus), measure_settling(fmus)
    report(result, times)
    save(plot(result, times), out / "quanser_lqr.png")


if __name__ == "__main__":
    main()
