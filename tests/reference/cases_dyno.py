"""Cases of a damper on a bench: set by a coil, one for each way in which its drive is known, and in a loose clevis."""

import math

from cases import single
from element_dyno import ElementDyno

DAMPER = {
    "strut.stiffness": 900.0,
    "strut.damping": 1285.0,
    "strut.preload": -40.0,
    "strut.yield.force": 235.0,
    "strut.yield.velocity": 0.03,
    "strut.yield.slope": 25.0,
    "control.yield_force": 354.0,
    "control.damping": 428.0,
    "control.saturation": 0.35,
    "control.lag": 0.012,
}
REST = {"sines": [], "steps": []}
# Amplitude in m, frequency in Hz, phase.
SINES = [(0.014, 1.1, 0.3), (0.003, 5.3, 1.4)]
MOTION = {
    "motion.position": {"steps": [], "sines": [list(sine) for sine in SINES]},
    "motion.velocity": {"steps": [],
                        "sines": [[2.0 * math.pi * f * a, f, phase + 0.5 * math.pi] for a, f, phase in SINES]},
}


INPUTS = {name: MOTION.get(name, REST) for name in ElementDyno.inputs}


def coil(by, signal, rated, description):
    inputs = INPUTS | {f"control.{by.lower()}": signal}
    return single(f"element-dyno-{by.lower()}", ElementDyno, inputs, stop=3.0, every=15, changed=DAMPER | rated,
                  settings={"controlled_by": by}, description=description)


CASES = [
    coil("Current", {"sines": [[0.5, 0.8, 0.6]], "steps": [[1.0, 0.0], [0.9, 1.2005], [-2.4, 2.1005]]},
         {"control.rated_current": 1.5, "control.rated_voltage": 1.0}, "A coil's current, which turns its direction."),
    coil("Voltage", {"sines": [[1.0, 2.1, 0.2]], "steps": [[2.5, 0.0], [-1.5, 1.0005]]},
         {"control.rated_current": 1.0, "control.rated_voltage": 2.0}, "A coil's voltage."),
    single("element-dyno-clevis", ElementDyno, INPUTS, stop=3.0, every=15, settings={"controlled_by": "Nothing"},
           changed={name: value for name, value in DAMPER.items() if not name.startswith("control.")} | {"clevis.gap": 8e-4},
           description="A damper in a loose clevis."),
]
