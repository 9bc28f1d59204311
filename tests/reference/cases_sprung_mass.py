"""Cases of the mass on a moved base, one for each way in which its motion is known."""

import math

from cases import single
from sprung_mass import SprungMass

SEAT = {
    "sprung_mass": 78.0,
    "strut.stiffness": 11000.0,
    "strut.damping": 620.0,
    "strut.asymmetry.ratio": 0.25,
    "strut.asymmetry.smoothing": 0.01,
    "strut.coulomb.force": 35.0,
    "strut.coulomb.velocity": 0.01,
    "guide.coulomb.force": 6.0,
    "guide.coulomb.velocity": 0.01,
    "guide.damping": 15.0,
}
FORCE = {"sines": [[60.0, 2.3, 0.4]], "steps": [[50.0, 1.2005]]}
REST = {"sines": [], "steps": []}
# Amplitude in m, frequency in Hz, phase of the base's motion.
SINES = [(0.012, 1.4, 0.2), (0.003, 4.1, 1.3)]


def rate(order):
    """The sines of the motion's derivative of an order."""
    return {"steps": [], "sines": [[a * (2.0 * math.pi * f) ** order, f, phase + 0.5 * math.pi * order] for a, f, phase in SINES]}


def seat(drive, inputs, description):
    inputs = {name: inputs.get(name, REST) for name in SprungMass.inputs} | {"actuator.force": FORCE}
    return single(f"sprung-mass-{drive.lower()}", SprungMass, inputs, stop=3.0, every=15, changed=SEAT,
                  settings={"drive": drive}, start={"body.velocity": 0.05, "base.velocity": 0.02} if drive == "Acceleration"
                  else {"body.velocity": 0.05}, description=description)


CASES = [
    seat("Motion", {"motion.position": rate(0), "motion.velocity": rate(1)}, "The base's motion is measured."),
    seat("Acceleration", {"motion.acceleration": rate(2)}, "The base's acceleration is measured."),
    seat("Deflection", {"imposed.deflection": rate(0), "imposed.velocity": rate(1)},
         "The deflection is measured, and the base is not."),
]
