"""Cases of the pneumatic cylinder."""

from cases import single
from pneumatic import PneumaticCylinder

DECLARED = {
    "moving_mass": 8.0,
    "actuator.supply.pressure": 7e5,
    "actuator.supply.exhaust_pressure": 101325.0,
    "actuator.air.filling_exponent": 1.4,
    "actuator.air.emptying_exponent": 1.0,
    "actuator.air.compression_exponent": 1.2,
    "actuator.cylinder.area": 8.042e-4,
    "actuator.cylinder.rod_area": 1.131e-4,
    "actuator.cylinder.stroke": 0.2,
    "actuator.cylinder.end_stiffness": 2e5,
    "actuator.cylinder.leakage": 0.0,
    "actuator.cylinder.chamber_a.dead_volume": 2e-5,
    "actuator.cylinder.chamber_b.dead_volume": 2e-5,
    "actuator.cylinder.chamber_a.flow_offset": 0.0,
    "actuator.cylinder.chamber_b.flow_offset": 0.0,
    "actuator.valve.conductance": 1e-8,
    "actuator.valve.critical_ratio": 0.3,
    "actuator.valve.laminar_ratio": 0.999,
    "actuator.spool.gain": 0.2,
    "actuator.spool.time_constant": 5e-3,
    "actuator.spool.overlap": 0.0,
}
GUIDE = {
    "guide.damping": 40.0,
    "guide.coulomb.force": 15.0,
    "guide.coulomb.velocity": 0.008,
    "guide.stribeck.force": 6.0,
    "guide.stribeck.velocity": 0.02,
}


def cylinder(name, voltage, load, changed, description):
    inputs = {"voltage": voltage, "load.force": load}
    return single(name, PneumaticCylinder, inputs, stop=3.0, every=15, parameters=DECLARED, changed=changed,
                  start={"carriage.position": 0.01, "chamber_a.pressure": 3.5e5, "chamber_b.pressure": 3.9e5},
                  description=description)


CASES = [
    cylinder("pneumatic-cylinder", {"sines": [[2.0, 1.1, 0.3], [1.0, 3.7, 1.2]], "steps": [[-0.4, 1.4005]]},
             {"sines": [], "steps": [[-30.0, 2.0005]]},
             GUIDE | {"constant_load": 4.0, "actuator.cylinder.leakage": 2e-11, "actuator.spool.overlap": 0.03,
                      "actuator.cylinder.chamber_a.flow_offset": 2e-6, "actuator.cylinder.chamber_b.flow_offset": -3e-6},
             "To and fro, with friction, leakage, overlap and loads."),
    cylinder("pneumatic-cylinder-end", {"sines": [], "steps": [[7.0, 0.0], [-12.0, 1.8005]]},
             {"sines": [], "steps": [[20.0, 1.0005]]},
             {"guide.damping": 120.0, "actuator.air.filling_exponent": 1.2, "actuator.air.emptying_exponent": 1.2},
             "From one end of the stroke to the other, with all edges wide open."),
]
