"""Konieczny's actuator, his rig from physics and as identified."""

from cases import single
from parameter_sets import SETS
from servo import ServoHydraulicActuator, ServoSuspension, ServoSuspensionIdentified
from stimulus import road_sines

# Konieczny, Notations. The laminar range is assumed; the regression is eq. 2.24 over alpha.
CYLINDER = {
    "supply.pressure": 12e6, "fluid.density": 880.0, "fluid.bulk_modulus": 1.4e9, "cylinder.area": 0.765786e-3,
    "cylinder.volume": 45.9458e-6, "cylinder.hose_volume": 80.0398e-6, "cylinder.leakage": 15e-12,
    "valve.discharge_coefficient": 0.611, "valve.perimeter": 15.708e-3, "valve.laminar_pressure": 0.1e6,
    "valve.regression.flow_gain": 1.049730, "valve.regression.pressure_coefficient": 7.67612e-12,
    "spool.gain": 0.025e-3, "spool.time_constant": 2.32e-3, "spool.stroke": 0.5e-3}
RIG = SETS["konieczny"] | {f"actuator.{name}": value for name, value in CYLINDER.items()}

# Every effect that the quarter car has, too.
EFFECTS = {"strut.asymmetry.ratio": 0.3, "strut.coulomb.force": 60.0, "strut.coulomb.velocity": 0.02,
           "guide.coulomb.force": 20.0, "guide.coulomb.velocity": 0.03, "tire.quadratic": 4e5,
           "tire.coulomb.force": 30.0, "tire.coulomb.velocity": 0.02}

# Beyond the spool's stroke (20 V) and, in the pressure, beyond the supply.
FAST = {"voltage": {"sines": [[9.0, 7.0, 0.3], [4.0, 31.0, 1.1]], 
                    "steps": [[20.0, 0.3005], [-45.0, 0.5005], [25.0, 0.7505]]},
        "suspension.velocity": {"sines": [[0.6, 5.0, 0.9], [0.3, 23.0, 0.1]], "steps": []}}
POSITION, VELOCITY = road_sines([[0.010, 1.1, 0.2], [0.002, 6.3, 0.8]])
RIDE = {"voltage": {"sines": [[2.5, 2.7, 0.4], [1.0, 19.0, 0.2]], "steps": [[4.0, 0.5005], [-5.0, 0.8005]]},
        "road.position": POSITION | {"steps": [[0.02, 0.3005]]}, "road.velocity": VELOCITY}


def actuator(name, law, stop=0.6, **options):
    return single(name, ServoHydraulicActuator, FAST, stop=stop, every=4, package="KoniecznyServoHydraulicActuator",
                  parameters=CYLINDER, settings={"law": law}, **options)


def suspension(name, law, **options):
    return single(name, ServoSuspension, RIDE, stop=1.2, every=5, package="KoniecznyServoSuspension",
                  parameters=RIG, settings={"actuator.law": law}, **options)


CASES = [
    actuator("servo-actuator", "Nonlinear", stop=1.0, start={"pressure": 3e6, "spool.position": -1e-4},
             description="Full stroke, stall, and a load that drives the oil back into the supply."),
    actuator("servo-actuator-linear", "Linear"),
    actuator("servo-actuator-regression", "Regression"),
    actuator("servo-actuator-loaded", "Nonlinear", start={"pressure": 3e6, "spool.position": -1e-4},
             changed={"load.mass": 200.0, "load.interval": 2e-3},
             description="Knows its load, with an interval of two steps; what is moved whatever the force is like a large mass."),
    suspension("servo-suspension", "Nonlinear"),
    suspension("servo-suspension-linear", "Linear"),
    suspension("servo-suspension-effects", "Nonlinear", changed=EFFECTS, start={"wheel.position": 0.005}),
    single("servo-suspension-identified", ServoSuspensionIdentified,
           {"voltage": RIDE["voltage"], "road.position": RIDE["road.position"]}, stop=2.0, every=8, step=2e-3,
           parameters={"length_unit": 1e-3, "pressure_unit": 1e5, "power_unit": 1e5},
           start={"supply.power": 500.0, "body.position": 0.004},
           description="Started with a power, which only decays (row 6)."),
]
