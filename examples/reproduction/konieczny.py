"""Konieczny, electrohydraulic full active suspension."""

from ctypes import c_double

import numpy as np
from measure import exchanged, linearise, parameters
from output import plt
from published import missing, taken
from sheet import Claim, Figure, Number, Section
from ssp import open_system

# Eq. 4.2: the characteristic polynomial from s^5 down to the constant; then the eigenvalues as printed.
POLYNOMIAL = [177, 15713, 300095, 6612388, 14887015, 8559185]
EIGENVALUES = [-1, -1.439, -7.495 + 20.570j, -79.786 + 77.775j]
# Eq. 3.2, states z_2, its rate, z_1, its rate, pressure, power; inputs v, w. In the units of the source.
A = [
    [0, 1, 0, 0, 0, 0],
    [-231, -46, 23, 40, 2504, -401800],
    [0, 0, 0, 1, 0, 0],
    [305, 50, -1248, -77, -3493, 596600],
    [2, -1, -6, 1, -53, 10220],
    [0, 0, 0, 0, 0, -1],
]
B = [[0, 0], [4442, 212], [0, 0], [-6879, 949], [47, 4], [0, 0]]
MODES = [(0.15915, 1.0), (0.22894, 1.0), (3.4843, 0.34234), (17.733, 0.71607)]


def derived(fmus):
    """Notations and section 2: what follows from other printed numbers."""
    found = parameters(fmus, "KoniecznyServoHydraulicActuator")
    reason = "4 E/(V_t + V_p) of the printed values is 10^12 times as large"
    yield Number("hydraulic coefficient α", "Notations", 44.4495, found["coefficient"], 0.00006, "N/m⁵", reason)
    stroke = found["cylinder.volume"] / found["cylinder.area"]
    yield Number("cylinder stroke h, as V_t/A_a", "Notations", 0.06, stroke, 0.00006, "m")
    yield Number("spool diameter d, as l/π", "Notations", 0.005, found["valve.perimeter"] / np.pi, 0.000006, "m")
    yield Number("C_d = π/(π + 2)", "eq. 2.9", 0.611, np.pi / (np.pi + 2), 0.0006)
    rig = parameters(fmus, "KoniecznyQuarterCar")
    yield Number("unsprung over sprung mass", "2.2", 0.13, rig["unsprung_mass"] / rig["sprung_mass"], 0.006)
    taylor = found["coefficient"] * found["flow_gain"]
    reason = "the tangent (2.23) at rest; a regression over an interval has less"
    yield Number("Φ over the spool's position, tangent", "eq. 2.24", 4.666e13, taylor, 0.6e10, "Pa/(m s)", reason)
    on_pressure, on_spool = regression(fmus)
    reason = "how the interval was sampled is not printed; this is a uniform grid, sines bring 4.87e13 and −343"
    yield Number("Φ over the spool's position, regression", "eq. 2.24", 4.666e13, on_spool, 0.6e10, "Pa/(m s)", reason)
    yield Number("Φ over the pressure, regression", "eq. 2.24", -341.2, on_pressure, 0.06, "1/s", reason)
    chosen = found["coefficient"] * np.array(
        [found["valve.regression.flow_gain"], -found["valve.regression.pressure_coefficient"]]
    )
    where = "of the FMU's law Regression"
    yield Number(f"Φ over the spool's position {where}", "eq. 2.24", 4.666e13, chosen[0], 0.6e10, "Pa/(m s)")
    yield Number(f"Φ over the pressure {where}", "eq. 2.24", -341.2, chosen[1], 0.06, "1/s")


def regression(fmus):
    """Φ of eq. 2.18 fitted by a plane over ±7 MPa and ±0.25 mm: slopes over pressure and spool."""
    pressures, spools = np.linspace(-7e6, 7e6, 101), np.linspace(-0.25e-3, 0.25e-3, 101)
    points = [(pressure, spool) for pressure in pressures for spool in spools]
    with exchanged(fmus, "KoniecznyServoHydraulicActuator") as (fmu, description, _):
        states = [entry.variable.derivative.name for entry in description.derivatives]

        def rate(pressure, spool):
            # What follows a valve with hysteresis does nothing without.
            values = {"pressure": pressure, "spool.position": spool, "spool.follower": 0.0}
            vector = c_double * len(states)
            fmu.setContinuousStates(vector(*(values[name] for name in states)), len(states))
            rates = vector()
            fmu.getDerivatives(rates, len(states))
            return rates[states.index("pressure")]

        # What leaks does not depend on the spool.
        flow = [rate(*point) - rate(point[0], 0.0) for point in points]
    slopes, *_ = np.linalg.lstsq(np.array(points), np.array(flow), rcond=None)
    return slopes


def identified(fmus):
    """Sections 3 and 4: the identified model, through model exchange."""
    linear = linearise(fmus, "ServoSuspensionIdentified", ["voltage", "road.position"])
    matrix = linear.a
    sizes = parameters(fmus, "ServoSuspensionIdentified")
    length, pressure, power = (sizes[f"{what}_unit"] for what in ("length", "pressure", "power"))
    units = np.array([length, length, length, length, pressure, power])
    for name, printed, found in (
        ("A", np.array(A, float), linear.a * units / units[:, None]),
        ("B", np.array(B, float), linear.b * np.array([1.0, length]) / units[:, None]),
    ):
        wrong = int(np.count_nonzero(np.abs(found - printed) > 1e-9 * np.abs(printed)))
        what = f"entries of {name} that are as printed, of {printed.size}"
        yield Number(what, "eq. 3.2", printed.size, printed.size - wrong, 0.1)
    for power, printed, found in zip(range(5, -1, -1), POLYNOMIAL, np.poly(matrix)[1:], strict=True):
        yield Number(f"characteristic polynomial, coefficient of s^{power}", "4.2", printed, found, 0.5)
    values = sorted((value for value in np.linalg.eigvals(matrix) if value.imag >= 0), key=abs)
    for number, (printed, found) in enumerate(zip(EIGENVALUES, values, strict=True), 1):
        yield Number(f"eigenvalue {number}, real part", "4", printed.real, found.real, 0.0006, "1/s")
        if printed.imag:
            yield Number(f"eigenvalue {number}, imaginary part", "4", printed.imag, found.imag, 0.0006, "1/s")
    for number, ((frequency, ratio), value) in enumerate(zip(MODES, values, strict=True), 1):
        found = abs(value) / (2 * np.pi)
        yield Number(f"natural frequency {number}", "4.3", frequency, found, 0.6 * 10.0 ** -digits(frequency), "Hz")
        yield Number(f"damping ratio {number}", "4.4", ratio, -value.real / abs(value), 0.6e-5)


def phenomenological(fmus):
    """The resonance of section 2's model, about rest: the mode nearest to the identified one."""
    modes = linearise(fmus, "KoniecznyServoSuspension").modes()
    return min(modes, key=lambda mode: abs(np.log(mode[0] / MODES[2][0])))


def locked(fmus):
    _, ratio = phenomenological(fmus)
    reason = (
        "with the printed parameters the closed valve locks the suspension, and body and wheel swing on the tyre, which "
        "damps little; the identified model, and with it the rig, has a far softer actuator"
    )
    yield Number("damping ratio of this resonance in the model of section 2", "4.4", MODES[2][1], ratio, 0.01, "", reason)


def digits(value):
    """Decimals of a number printed with five significant digits."""
    return 4 - int(np.floor(np.log10(value)))


def gains(fmus, frequencies):
    """Body position over road position and over voltage, in dB, of each model."""
    models = {
        "nonlinear, linearised exactly": ("KoniecznyServoSuspension", None),
        "identified": ("ServoSuspensionIdentified", None),
    }
    responses = {}
    for label, (name, start) in models.items():
        linear = linearise(fmus, name, ["road.position", "voltage"], ["body.position"], start)
        responses[label] = 20 * np.log10(np.abs(linear.response(frequencies)[:, 0, :]))
    return responses


def draw_gains(fmus):
    frequencies = np.geomspace(0.1, 100.0, 600)
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
    for label, response in gains(fmus, frequencies).items():
        for panel, values in zip(axes, response.T, strict=True):
            panel.semilogx(frequencies, values, label=label)
    axes[0].set(xlabel="frequency in Hz", ylabel="body over road in dB", ylim=(-60, 20))
    axes[1].set(xlabel="frequency in Hz", ylabel="body over voltage in dB re 1 m/V")
    axes[0].legend()
    return figure


def draw_step(step):
    figure, axes = plt.subplots(figsize=(8, 3.4), layout="constrained")
    axes.plot(step["time"], step["road.position"], color="0.6", label="road")
    axes.plot(step["time"], step["rig.body.position"], label="body, phenomenological model")
    axes.plot(step["time"], step["identified.body.position"], label="body, identified model")
    axes.set(xlabel="time in s", ylabel="position in m", xlim=(0, 3))
    axes.legend()
    return figure


def draw_chirp(sweep):
    figure, (road, voltage, body) = plt.subplots(
        3, 1, sharex=True, figsize=(9, 6), height_ratios=(1, 1, 2), layout="constrained"
    )
    time = sweep["time"]
    road.plot(time, 1e3 * sweep["road.position"], color="0.4", linewidth=0.8)
    road.set_ylabel("road in mm")
    voltage.plot(time, sweep["source.voltage"], color="tab:green", linewidth=0.5)
    voltage.set_ylabel("voltage in V")
    body.plot(time, 1e3 * sweep["rig.body.position"], linewidth=0.8, label="phenomenological model")
    body.plot(time, 1e3 * sweep["identified.body.position"], linewidth=0.8, label="identified model")
    body.set(xlabel="time in s", ylabel="body in mm", xlim=(0, time[-1]))
    body.legend(loc="upper right")
    return figure


def run(fmus, name, stop, signals):
    with open_system(fmus, name) as system:
        return system.run(stop, 1e-3, ["road.position", "rig.body.position", "identified.body.position", *signals])


def claims(fmus, sweep):
    undamped = {"strut.stiffness": 8000.0, "tire.stiffness": 44800.0, "strut.damping": 0.0, "tire.damping": 0.0}
    body, wheel = sorted({round(mode[0], 6) for mode in linearise(fmus, "KoniecznyQuarterCar", start=undamped).modes()})
    yield Claim(
        "with the predicted stiffnesses, 8000 and 44800 N/m, the modes are near 1.5 Hz and 11 Hz",
        "Notations, 2.2",
        f"{body:.2f} Hz and {wheel:.2f} Hz",
        abs(body / 1.5 - 1.0) < 0.1 and abs(wheel / 11.0 - 1.0) < 0.1,
    )
    frequencies = np.geomspace(0.1, 100.0, 4000)
    response = gains(fmus, frequencies)["identified"][:, 0]
    peak = float(frequencies[np.argmax(response)])
    yield Claim(
        "the road's motion is amplified near the resonance at 3.48 Hz",
        "Fig. 10",
        f"largest gain {response.max():.1f} dB at {peak:.2f} Hz",
        2.5 < peak < 4.0 and response.max() > 0,
    )
    frequency, _ = phenomenological(fmus)
    yield Claim(
        "both models have this resonance",
        "4, Fig. 6",
        f"model of section 2: {frequency:.2f} Hz, identified: {MODES[2][0]:.2f} Hz",
        abs(frequency / MODES[2][0] - 1) < 0.15,
    )
    # The last second of each half period of the square wave: the oscillation has died away.
    settled = sweep["time"] % 2.0 > 1.5
    late = settled & (sweep["time"] > 20.0)
    apart = float(np.abs(np.subtract(*(sweep[f"{model}.body.position"][late] for model in ("rig", "identified")))).max())
    yield Claim(
        "both models follow the square wave",
        "3.1, Fig. 6",
        f"at most {1e3 * apart:.1f} mm apart half a second before the next edge, of ±10 mm",
        apart < 0.01,
    )


def section(fmus):
    step = run(fmus, "konieczny-open-loop", 6.0, [])
    sweep = run(fmus, "konieczny-square-chirp", 40.0, ["source.voltage"])
    figures = [
        Figure("konieczny-step.png", "A step of the road of 0.1 m (Konieczny Fig. 9)", lambda: draw_step(step)),
        Figure("konieczny-chirp.png", "Square wave of ±10 mm, sweep of ±3 V (Konieczny Fig. 6)", lambda: draw_chirp(sweep)),
        Figure("konieczny-gains.png", "Frequency responses (Konieczny Fig. 5 and 10)", lambda: draw_gains(fmus)),
    ]
    title = "Konieczny: electrohydraulic full active suspension"
    numbers = [*derived(fmus), *identified(fmus), *locked(fmus)]
    given = list(taken(fmus, "konieczny")), list(missing("konieczny"))
    return Section(title, numbers, list(claims(fmus, sweep)), figures, *given)
