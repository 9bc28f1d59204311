"""Ajala, Bestle, Rauh: electro-hydraulic active suspension. No parameter value is printed: figures only."""

import ajala_force
import full_car
import numpy as np
from jacobi import System
from output import plt
from published import missing, taken
from sheet import Claim, Figure, Section
from spectra import LINES, STEP, lines_of, multisine
from ssp import read

VARIANTS = {
    "passive": ("ajala-two-dof", {"actuator.pump.locked": True}),
    "PID-H": ("ajala-pid-h", {}),
    "PID-L": ("ajala-pid-l", {}),
    "2-DOF": ("ajala-two-dof", {}),
}
STYLE = {
    "passive": {"color": "0.6", "linewidth": 2.5},
    "PID-H": {"color": "tab:red", "linestyle": ":"},
    "PID-L": {"color": "tab:orange", "linestyle": "--"},
    "2-DOF": {"color": "black"},
}


def response(fmus, variant, settling=3):
    """Magnitudes of body acceleration and tyre load over the road, line by line; sampled controllers and all."""
    name, changes = VARIANTS[variant]
    components, connections, parameters = read(fmus / f"{name}.ssp")
    del components["road"]
    connections = [(source, target) for source, target in connections if not source.startswith("road.")]
    parameters = {name: value for name, value in parameters.items() if not name.startswith("road.")}
    time, height, velocity = multisine()
    rows = []
    with System(fmus, components, connections, parameters | changes) as system:
        rig = system.components["rig"]
        inputs = rig.references(["road.position", "road.velocity"])
        seen = {"rig": ["body.acceleration", "wheel.force"]}
        system.initialize()
        for index in range((settling + 1) * len(time)):
            now = index % len(time)
            rig.fmu.setReal(inputs, [height[now], velocity[now]])
            system.step(index * STEP, STEP)
            if index >= settling * len(time):
                rows.append(list(system.read(seen).values()))
    road = lines_of(height, time)
    return [np.abs(lines_of(column, time) / road) for column in np.array(rows).T]


def at(values, low, high):
    """The largest value in a band, and its frequency."""
    band = (low - 1e-9 <= LINES) & (high + 1e-9 >= LINES)
    index = np.argmax(np.where(band, values, 0.0))
    return float(values[index]), float(LINES[index])


def quarter_car_claims(responses):
    passive = responses["passive"][0]
    around_body = {label: at(values[0], 0.5, 2.0)[0] / at(passive, 0.5, 2.0)[0] for label, values in responses.items()}
    shares = [around_body[label] for label in ("PID-H", "PID-L", "2-DOF")]
    yield Claim(
        "all three controllers reduce the body's acceleration around its mode alike",
        "3.3, Fig. 4a",
        "largest value, 0.5–2 Hz, over the passive one: " + ", ".join(f"{share:.2f}" for share in shares),
        max(shares) < 0.75,
    )
    for index, what, figure in ((0, "acceleration", "4a"), (1, "tyre load", "4b")):
        reference = responses["passive"][index]
        for label, low, high, typical in (("PID-H", 11.0, 17.0, "14 Hz"), ("PID-L", 2.5, 4.5, "3 Hz")):
            value, frequency = at(responses[label][index], low, high)
            ratio = value / float(np.interp(frequency, LINES, reference))
            yield Claim(
                f"{label}: resonance of the {what} near {typical}",
                f"Fig. {figure}",
                f"{ratio:.2f} × passive at {frequency:.1f} Hz",
                ratio > 1.2,
            )
        ratios = responses["2-DOF"][index] / reference
        middle = float(ratios[(LINES > 2.5) & (LINES < 4.5)].max())
        wheel = at(responses["2-DOF"][index], 11.0, 17.0)[0] / at(reference, 11.0, 17.0)[0]
        # Beyond the wheel's mode, which both have at slightly different frequencies.
        high = ratios[LINES > 16.0]
        worst = float(ratios[LINES > 4.5].max())
        yield Claim(
            f"2-DOF: neither resonance, and like the passive suspension at high frequency ({what})",
            f"Fig. {figure}",
            f"at most {middle:.2f} × passive near 3 Hz, largest near 14 Hz {wheel:.2f} × that of passive, "
            f"{high.min():.2f}–{high.max():.2f} × above 16 Hz; in between up to {worst:.2f} × at "
            f"{LINES[LINES > 4.5][np.argmax(ratios[LINES > 4.5])]:.1f} Hz",
            middle < 1.1 and wheel < 1.2 and 0.75 < high.min() and high.max() < 1.25,
        )


def draw_responses(responses):
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 4), layout="constrained")
    for index, panel in enumerate(axes):
        for label, values in responses.items():
            panel.loglog(LINES, values[index], label=label, **STYLE[label])
        panel.set(xlabel="frequency in Hz", xlim=(0.3, 25))
        panel.set_xticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"])
        panel.minorticks_off()
    axes[0].set_ylabel("body acceleration over road in 1/s²")
    axes[1].set_ylabel("tyre load over road in N/m")
    axes[0].legend()
    return figure


def full_car_claims(results):
    measured = {full_car.LABELS[name]: full_car.bands(result) for name, result in results.items()}
    for motion in full_car.MOTIONS:
        soft, hard, active = (list(measured[label][motion].values()) for label in ("soft", "hard", "active"))
        yield Claim(
            f"{motion}: hard dampers help around the body's mode and harm at 2–8 Hz",
            "5, Fig. 8",
            f"{hard[0] / soft[0]:.2f} × soft below 2 Hz, {hard[1] / soft[1]:.2f} × at 2–8 Hz",
            hard[0] < soft[0] and hard[1] > soft[1],
        )
        yield Claim(
            f"{motion}: active is best around the body's mode, and like soft at high frequency",
            "5, Fig. 8",
            f"{active[0] / soft[0]:.2f} × soft below 2 Hz, {active[2] / soft[2]:.2f} × above 8 Hz",
            active[0] < min(soft[0], hard[0]) and 0.8 < active[2] / soft[2] < 1.25,
        )


def section(fmus):
    loops = {label: ajala_force.closed_loop(fmus, fmu) for label, fmu in ajala_force.CONTROLLERS.items()}
    responses = {label: response(fmus, label) for label in VARIANTS}
    records = {label: ajala_force.on_the_rig(fmus, label == "passive") for label in ("passive", "controlled")}
    cars = {name: full_car.simulate(fmus, name) for name in full_car.SYSTEMS}
    claims = [
        *ajala_force.loop_claims(loops),
        *quarter_car_claims(responses),
        *ajala_force.rig_claims(records),
        *full_car_claims(cars),
    ]
    figures = [
        Figure("ajala-loops.png", "The closed force loops (Ajala Fig. 2b)", lambda: ajala_force.draw_loops(loops)),
        Figure("ajala-responses.png", "Road to body and tyre (Ajala Fig. 4)", lambda: draw_responses(responses)),
        Figure(
            "ajala-forces.png",
            "Wanted and measured force of an actuator that is moved (Ajala Fig. 6)",
            lambda: ajala_force.draw_records(records),
        ),
        Figure("ajala-full-car.png", "Modal accelerations at 70 km/h (Ajala Fig. 8)", lambda: full_car.plot(cars)),
    ]
    title = "Ajala: electro-hydraulic active suspension"
    return Section(title, [], claims, figures, list(taken(fmus, "ajala")), list(missing("ajala")))
