"""Kogut, semi-active suspension (SAS) of AGH Krakow."""

import math

import numpy as np
from measure import linearise, parameters, rms, stepped
from output import plt
from published import missing, taken
from sheet import Claim, Figure, Number, Section
from ssp import open_system

STEP = 1e-3
SIGNALS = ["rig.wheel_arm.angle", "rig.body_arm.angle", "drive.height", "drive.speed"]
# Table 1: a_1, a_2 of experiments 1 to 5 and of all.
TABLE_1 = {
    "1": (526.61, 22.07),
    "2": (531.13, 22.37),
    "3": (535.59, 22.64),
    "4": (538.56, 22.76),
    "5": (542.34, 22.91),
    "all": (528.57, 22.07),
}
# Fig. 15-17: the brake's duty at 1.6 Hz.
DUTIES = {0.3: "sas-30-percent", 0.7: "sas-70-percent", 1.0: "sas-100-percent"}


def at_rest(fmus):
    rig = parameters(fmus, "KogutSasRig")
    yield Number("wheel arm at rest", "3.2.2", -0.195, rig["rest.wheel_arm_angle"], 0.0006, "rad")
    reason = "the printed parameters are rounded; the measured 0.36 rad (eq. 20) was no exact value either"
    yield Number("body arm at rest", "3.2.2", 0.354, rig["rest.body_arm_angle"], 0.0006, "rad", reason)
    yield Number("spring rate k_s", "3.1.2", 3790, rig["spring.stiffness"], 6, "N/m")
    yield Number("tyre rate k_t", "3.2.2", 1.09e5, rig["tire.stiffness"], 500, "N/m")
    lever = rig["wheel_arm.length"] * math.cos(rig["wheel_arm.offset"] - rig["rest.wheel_arm_angle"])
    reason = "a_2 I_1 with the printed a_2 = 1.44e3; in N s, not N s/m"
    yield Number("tyre damping b_t", "3.2.2", 305.27, rig["tire.damping"] * lever, 0.006, "N s", reason)
    wheel_lever = rig["spring.stiffness"] * rig["spring.wheel_arm_mount"] / rig["wheel_arm.inertia"]
    yield Number("a_4 = k_s r_s1/I_1", "3.2.2", 4920, wheel_lever, 11, "1/s²")
    # First part: the wheel arm horizontal; the spring's moment balances the arm's weight.
    mounts = rig["spring.wheel_arm_mount"], rig["spring.body_arm_mount"]
    length = math.sqrt(mounts[0] ** 2 + mounts[1] ** 2 - 2 * mounts[0] * mounts[1] * math.cos(0.57))
    spring = rig["spring.stiffness"] * mounts[1] * (rig["spring.free_length"] - length) / rig["body_arm.inertia"]
    weight = rig["body_arm.gravity_moment"] * math.cos(0.57) / rig["body_arm.inertia"]
    yield Number("spring against weight at 0.57 rad (3.1.2), per inertia", "3.1", weight, spring, 0.02, "1/s²")


def table_1(fmus):
    """The locked rig with what each experiment has found: the rest is what all began at."""
    inertia = parameters(fmus, "KogutLockedSasRig")["body_arm.inertia"]
    mount = parameters(fmus, "KogutLockedSasRig")["spring.body_arm_mount"]
    for experiment, (spring, weight) in TABLE_1.items():
        start = {"spring.stiffness": spring * inertia / mount, "body_arm.gravity_moment": weight * inertia}
        rest = parameters(fmus, "KogutLockedSasRig", start)["rest.body_arm_angle"]
        what = f"rest with a_1 = {spring} and a_2 = {weight}, wheel arm locked"
        yield Number(what, f"Table 1, {experiment}; x_10", 0.57, rest, 0.006, "rad")
    found = parameters(fmus, "KogutLockedSasRig")
    coefficients = (found["spring.stiffness"] * mount / inertia, found["body_arm.gravity_moment"] / inertia)
    for name, printed, value in zip(("a_1", "a_2"), TABLE_1["all"], coefficients, strict=True):
        yield Number(f"{name} of the FMU", "Table 1, all", printed, value, 0.006, "1/s²")
    brake = parameters(fmus, "KogutMrRotaryBrake")
    yield Number("b(0) of the FMU's brake", "Table 1, all", 0.1921, brake["damping"] / inertia, 0.00006, "1/s")


def tilted_rest(fmus):
    """Eq. 20: where the body arm rests with the wheel arm locked at -0.19 rad instead of 0."""
    low, high = 0.2, 0.6
    while high - low > 1e-5:
        middle = 0.5 * (low + high)
        start = {"wheel_arm.angle": -0.19, "body_arm.angle": middle}
        falls = parameters(fmus, "KogutLockedSasRig", start)["body_arm.acceleration"] < 0.0
        low, high = (low, middle) if falls else (middle, high)
    return low


def parts(fmus):
    """Numbers of single parts."""
    yield Number("rest of the body arm, wheel arm at −0.19 rad", "eq. 20, x_30", 0.36, tilted_rest(fmus), 0.006, "rad")
    rig = parameters(fmus, "KogutSasRig")
    inverse = 1.0 / rig["wheel_arm.inertia"]
    # Digits are cut off: 4.726.
    yield Number("k_1 = 1/I_1", "3.2.2", 4.72, inverse, 0.011, "1/(kg m²)")
    weight = rig["wheel_arm.gravity_moment"] / rig["wheel_arm.inertia"]
    yield Number("a_3 of the FMU", "3.2.2", 46.71, weight, 0.006, "1/s²")
    yield Number("a_3 = g/R", "3.2.2", 46.71, 9.81 / rig["wheel_arm.length"], 0.006, "1/s²")
    stiffness = rig["tire.stiffness"] * rig["wheel_arm.length"] / rig["wheel_arm.inertia"]
    yield Number("a_1 = k_t R/I_1", "3.2.2", 1.08e5, stiffness, 600, "1/(m s²)")
    top = parameters(fmus, "KogutEccentricDrive", {"angle": math.pi})["height"]
    yield Number("highest level of the eccentric", "3.2.2", 0.045, top, 0.00006, "m")
    for angle, height, printed in ((-0.19, 0.04, 0.0015), (-0.167, 0.045, 0.002)):
        start = {"wheel_arm.angle": angle, "eccentric.height": height}
        found = parameters(fmus, "KogutSasRig", start)["tire.compression"]
        reason = "" if angle == -0.167 else "half a unit of the angle's last digit is worth 1 mm"
        what = f"tyre squeezed by, wheel arm at {angle:g} rad".replace("-", "−")
        yield Number(what, "3.2.2", printed, found, 0.00006, "m", reason)
    yield Number("accuracy of the encoders", "2.1", 0.001534, count(fmus), 0.6e-6, "rad")
    yield Number("response time of the brake, to nine tenths", "2.3", 0.01, response_time(fmus), 0.0006, "s")


def count(fmus):
    """What the encoder shows of an angle a little larger than one count."""
    return float(stepped(fmus, "SasSensorChain", "measured.eccentric.angle", {"eccentric.angle": 0.0016}, 1e-3)[-1])


def response_time(fmus):
    """When the brake's field has made nine tenths of its way to full duty."""
    size = 1e-4
    field = stepped(fmus, "KogutMrRotaryBrake", "field", {"duty": 1.0}, 0.05, size)
    return float(size * (1 + np.argmax(field >= 0.9)))


def run(fmus, name, stop):
    with open_system(fmus, name) as system:
        return system.run(stop, STEP, SIGNALS, every=10)


def steady_swing(result):
    """RMS of the body arm about its mean in the second half of a run."""
    angle = result["rig.body_arm.angle"][len(result["time"]) // 2 :]
    return rms(angle - np.mean(angle))


def claims(fmus, ramp, results):
    body, _ = linearise(fmus, "KogutSasRig").modes()[0]
    yield Claim(
        "the body's resonance lies where it swings up (1.35 Hz) and is damped by the brake (1.6 Hz)",
        "Fig. 3, 15–17",
        f"mode about rest at {body:.2f} Hz",
        1.35 < body < 1.6,
    )
    time, frequency = ramp["time"], ramp["drive.speed"] / math.tau
    # Between 1 and 2 Hz: where the body swings most.
    part = (time > 10.0) & (time < 20.0)
    missing = float(np.abs(frequency - 0.1 * time)[part].max())
    yield Claim(
        "the controller keeps the eccentric to the ramp of frequency",
        "Fig. 4",
        f"at most {missing:.3f} Hz off between 1 and 2 Hz",
        missing < 0.2,
    )
    body = ramp["rig.body_arm.angle"]
    at = float(0.1 * time[part][np.argmax(np.abs(body[part] - np.mean(body[:200])))])
    yield Claim(
        "the body swings up on the way through its resonance, between Fig. 3's 1.35 Hz and Fig. 15's 1.6 Hz",
        "Fig. 3, 13",
        f"largest swing at {at:.2f} Hz of the ramp",
        1.3 < at < 1.75,
    )
    swings = {duty: steady_swing(result) for duty, result in results.items()}
    yield Claim(
        "the brake damps the body's swing at 1.6 Hz",
        "Fig. 15–17",
        "RMS " + ", ".join(f"{1e3 * swing:.1f} mrad at {100 * duty:.0f} %" for duty, swing in swings.items()),
        swings[1.0] < swings[0.3],
    )


def draw_ramp(ramp):
    figure, (wheel, body, frequency) = plt.subplots(3, 1, sharex=True, figsize=(9, 6), layout="constrained")
    time = ramp["time"]
    wheel.plot(time, ramp["rig.wheel_arm.angle"], linewidth=0.7)
    wheel.set_ylabel("wheel arm in rad")
    body.plot(time, ramp["rig.body_arm.angle"], linewidth=0.7, color="tab:orange")
    body.set_ylabel("body arm in rad")
    frequency.plot(time, ramp["drive.speed"] / math.tau, linewidth=0.7, color="tab:green")
    frequency.plot(time, 0.1 * time, color="0.5", linestyle="--")
    frequency.set(xlabel="time in s", ylabel="frequency in Hz", xlim=(0, time[-1]))
    return figure


def draw_duties(results):
    figure, panels = plt.subplots(len(results), 1, sharex=True, sharey=True, figsize=(9, 6), layout="constrained")
    for panel, (duty, result) in zip(panels, results.items(), strict=True):
        panel.plot(result["time"], result["rig.body_arm.angle"], linewidth=0.8)
        panel.set_ylabel(f"{100 * duty:.0f} %")
    panels[-1].set(xlabel="time in s", xlim=(0, result["time"][-1]))
    figure.supylabel("body arm in rad, at a duty of")
    return figure


def section(fmus):
    ramp = run(fmus, "sas", 20.0)
    results = {duty: run(fmus, name, 20.0) for duty, name in DUTIES.items()}
    figures = [
        Figure("sas-ramp.png", "The rig on a ramp of frequency, 0.1 Hz/s (Kogut Fig. 13)", lambda: draw_ramp(ramp)),
        Figure("sas-brake.png", "The brake at 1.6 Hz (Kogut Fig. 15–17)", lambda: draw_duties(results)),
    ]
    title = "Kogut: semi-active suspension rig"
    numbers = [*table_1(fmus), *parts(fmus), *at_rest(fmus)]
    given = list(taken(fmus, "kogut")), list(missing("kogut"))
    return Section(title, numbers, list(claims(fmus, ramp, results)), figures, *given)
