"""Cases of the positioning drives, each effect at once."""

import math

from cases import single
from cases_effects import points
from linear_drive import LinearDrive, RotaryDrive

DECLARED = {"moving_mass": 20.0, "amplifier.gain": 1.0}
GUIDE = {
    "guide.damping": 60.0,
    "guide.coulomb.force": 15.0,
    "guide.coulomb.velocity": 0.008,
    "guide.stribeck.force": 6.0,
    "guide.stribeck.velocity": 0.02,
    "guide.cogging.force": 5.0,
    "guide.cogging.period": 0.03,
    "guide.cogging.phase": 0.4,
}
SPRING = {
    "ground_spring.stiffness": 400.0,
    "ground_spring.progression.quadratic": -300.0,
    "ground_spring.progression.cubic": 4000.0,
}
OMEGA = 2.0 * math.pi * 0.7
HALF_PI = 0.5 * math.pi
SINES = [[90.0, 0.9, 0.3], [40.0, 2.7, 1.2]]


REST = {"sines": [], "steps": []}


def drive(name, inputs, changed, description, settings=None):
    inputs = {name: inputs.get(name, REST) for name in LinearDrive.inputs}
    return single(name, LinearDrive, inputs, stop=3.0, every=15, parameters=DECLARED, changed=changed,
                  settings=settings, start={"carriage.position": 0.01, "carriage.velocity": -0.05}, description=description)


CASES = [
    drive("linear-drive-force",
          {"force": {"sines": SINES, "steps": [[30.0, 1.4005]]}, "load.force": {"sines": [], "steps": [[-12.0, 2.0005]]}},
          GUIDE | SPRING | {"constant_load": 4.0},
          "Friction with breakaway, cogging, spring and loads."),
    drive("linear-drive-command", {"command": {"sines": [[2.5, 0.8, 0.1], [1.0, 3.1, 0.7]], "steps": []}},
          GUIDE | {"amplifier.gain": 35.0, "guide.curve.scale": 1.2, "guide.curve.velocity_range": 0.4,
                   **points("guide.curve.over_velocity",
                            [-9.0, -7.0, -8.0, -4.0, -2.0, 0.0, 3.0, 5.0, 4.0, 8.0, 9.0])},
          "Behind an amplifier, with an unnamed force.", settings={"drive": "Command"}),
    # x, x' and x'' of one sine of 0.05 m and 0.7 Hz about 0.02 m.
    drive("linear-drive-motion",
          {"motion.position": {"sines": [[0.05, 0.7, 0.2]], "steps": [[0.02, 0.0]]},
           "motion.velocity": {"sines": [[0.05 * OMEGA, 0.7, 0.2 + HALF_PI]], "steps": []},
           "motion.acceleration": {"sines": [[-0.05 * OMEGA**2, 0.7, 0.2]], "steps": []},
           "load.force": {"sines": [], "steps": [[-12.0, 2.0005]]}},
          GUIDE | SPRING | {"constant_load": 4.0},
          "The motion is imposed and the force sought.", settings={"drive": "Motion"}),
    single("rotary-drive-torque", RotaryDrive,
           {name: {"torque": {"sines": [[0.4, 0.9, 0.3], [0.2, 2.7, 1.2]], "steps": [[0.1, 1.4005]]}}.get(name, REST)
            for name in RotaryDrive.inputs},
           stop=3.0, every=15, parameters={"inertia": 0.01, "amplifier.gain": 1.0},
           changed={"guide.damping": 0.02, "guide.coulomb.force": 0.05, "guide.coulomb.velocity": 0.4,
                    "guide.stribeck.force": 0.02, "guide.stribeck.velocity": 0.6, "guide.cogging.force": 0.02,
                    "guide.cogging.period": 0.5, "guide.cogging.phase": 0.4, "ground_spring.stiffness": 0.3,
                    "constant_load": 0.03},
           start={"shaft.position": 0.1, "shaft.velocity": -0.5},
           description="About an axis, with friction, breakaway, cogging, spring and load."),
]
