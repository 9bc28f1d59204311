"""Kogut's rig and its brake."""

import math

from cases import single
from eccentric import EccentricDrive, ExcitationSpeedController
from parameter_sets import V0
from sas import MrRotaryBrake, SasRig
from table import indexed

I1, I2, R = 0.2116, 1.37, 0.21
# Kogut 3.1.2 and 3.2.2. The tyre's damping is b_t = a_2 I_1 over the lever R cos(beta - alpha_1) at rest.
RIG = {
    "wheel_arm.inertia": I1, "wheel_arm.gravity_moment": 46.71 * I1, "wheel_arm.length": R, "wheel_arm.offset": 0.234,
    "body_arm.inertia": I2, "body_arm.gravity_moment": 22.07 * I2,
    "spring.stiffness": 528.57 * I2 / 0.191, "spring.free_length": 0.189, "spring.wheel_arm_mount": 0.275,
    "spring.body_arm_mount": 0.191, "pivot.coulomb.torque": 0.0, "pivot.coulomb.speed": 0.05,
    "wheel.rim_radius": 0.075, "wheel.tire_thickness": 0.02, "eccentric.depth": 0.22,
    "tire.stiffness": 1.08e5 * I1 / R, "tire.quadratic": 0.0, "tire.damping": 1595.557,
    "tire.coulomb.force": 0.0, "tire.coulomb.velocity": V0}
EFFECTS = {"pivot.coulomb.torque": 0.8, "pivot.coulomb.speed": 0.1, "tire.quadratic": 4e6, "tire.coulomb.force": 8.0,
           "tire.coulomb.velocity": 0.02, "tire.damping": 400.0}

# b(0) of Table 1 times I. The rest of Fig. 9 is lost: b(1) = 13.5 b(0) (2700 to 200 samples), levelling off, is
# assumed.
PROFILE = [round(0.1921 * I2 * (1.0 + 12.5 * u * (3.0 - u) / 2.0), 4) for u in (k / 20 for k in range(21))]


BRAKE = indexed("profile", PROFILE) | {"response_time": 0.01}

# All of the drive but the eccentric (eq. 15) and all of its controller is assumed, as the parameter sets say.
DRIVE = {
    "motor.supply_voltage": 24.0, "motor.resistance": 1.0, "motor.torque_constant": 0.07, "motor.inertia": 1.5e-4,
    "gear.ratio": 6.0, "eccentric.mean_height": 0.0425, "eccentric.eccentricity": 0.0025, "eccentric.inertia": 2.2e-4,
    "eccentric.coulomb.torque": 0.1, "eccentric.coulomb.speed": 0.5}
SPEED_CONTROLLER = {
    "position.gain": 10.0, "position.limit": 1.0, "velocity.feedforward": 0.0175, "velocity.proportional": 0.03,
    "velocity.integral": 0.8, "velocity.derivative": 0.0, "velocity.derivative_filter": 0.02, "duty_limit": 1.0,
    "period": 0.01}


def driven(amplitude, torque, frequency):
    """An eccentric about its height of rest, and a torque."""
    height = {"sines": [[amplitude, frequency, 0.3]], "steps": [[0.0425, -1.0]]}
    velocity = {"sines": [[2.0 * math.pi * frequency * amplitude, frequency, 0.3 + 0.5 * math.pi]], "steps": []}
    return {"brake.torque": {"sines": [[torque, 1.9, 0.2]], "steps": [[0.7 * torque, 0.8005]]},
            "eccentric.height": height, "eccentric.velocity": velocity}


def rig(name, inputs, package="KogutSasRig", locked=False, lever="Printed", lift_off=False, **options):
    return single(name, SasRig, inputs, stop=2.0, every=8, step=2e-3, package=package, parameters=RIG,
                  settings={"wheel_arm.locked": locked, "spring.lever": lever, "tire.lift_off": lift_off}, **options)


AWAY = {"wheel_arm.angle": -0.19, "wheel_arm.speed": 0.2, "body_arm.angle": 0.40, "body_arm.speed": -0.5}

CASES = [
    rig("sas-rig", driven(0.0025, 0.5, 1.6), start=AWAY,
        description="As printed, with the brake's torque put right."),
    rig("sas-rig-exact", driven(0.0025, 0.5, 3.1), lever="Exact", start=AWAY),
    rig("sas-rig-effects", driven(0.005, 3.0, 6.5), lever="Perpendicular", lift_off=True, changed=EFFECTS, start=AWAY,
        description="Friction between the arms, a nonlinear tyre that leaves the eccentric."),
    rig("sas-rig-locked", driven(0.0025, 1.0, 2.1), package="KogutLockedSasRig", locked=True,
        start={"wheel_arm.angle": 0.0, "body_arm.angle": 0.50},
        description="The first part of the identification (eq. 1)."),
    single("mr-rotary-brake", MrRotaryBrake, {
               "duty": {"sines": [[0.7, 1.3, 0.4]], "steps": [[0.3, 0.5005]]},
               "relative.speed": {"sines": [[2.0, 2.9, 0.1]], "steps": []}},
           stop=1.5, every=5, step=2e-3, package="KogutMrRotaryBrake",
           parameters=BRAKE, settings={"pwm.bits": 8},
           description="Duty cycles from beyond one end to beyond the other, in 255 steps."),
    single("eccentric-drive", EccentricDrive, {
               "duty": {"sines": [[0.6, 1.1, 0.3]], "steps": [[0.9, 0.6005], [-1.6, 0.9005]]},
               "tire.force": {"sines": [[120.0, 3.7, 0.2]], "steps": [[261.0, -1.0]]}},
           stop=1.5, every=5, step=2e-3, package="KogutEccentricDrive", parameters=DRIVE, settings={"pwm.bits": 8},
           description="Both directions, duty cycles beyond one, loaded by a tyre."),
    single("excitation-speed-controller", ExcitationSpeedController, {
               "frequency_reference": {"sines": [[0.5, 1.3, 0.4]], "steps": [[1.5, -1.0], [9.0, 0.6005], [-8.0, 0.8005]]},
               "eccentric.angle": {"sines": [[0.6, 1.1, 0.1]], "steps": [[3.0, 0.3005]]},
               "eccentric.speed": {"sines": [[6.0, 1.7, 0.9]], "steps": []}},
           stop=1.2, every=13, error=1e-12, package="KogutExcitationSpeedController", parameters=SPEED_CONTROLLER,
           changed={"velocity.derivative": 5e-4, "duty_limit": 0.6},
           description="Limits of the position tracking and of the duty cycle, with a derivative."),
]
