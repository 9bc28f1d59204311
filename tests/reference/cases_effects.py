"""Cases with the effects that a diagnosis looks for, on TUM's rig."""

from cases import RIG_FORCE, RIG_ROAD, single
from effects import QuarterCarWithEffects
from parameter_sets import SETS
from stimulus import road_sines


def with_effects(name, changed, description):
    position, velocity = road_sines(RIG_ROAD)
    position["steps"] = []
    sines, steps = RIG_FORCE
    inputs = {"road.position": position, "road.velocity": velocity, "actuator.force": {"sines": sines, "steps": steps}}
    start = dict(zip(QuarterCarWithEffects.states, [0.004, 0.05, -0.001, -0.08]))
    case = single(name, QuarterCarWithEffects, inputs, stop=3.0, every=15, package="TumQuarterVehicle",
                  parameters=SETS["tum-table-10"], changed=changed, settings={"tire.lift_off": False}, start=start,
                  description=description)
    # Its columns are those of the quarter car; only the reference is another one.
    return case | {"fmu": "QuarterCar", "reference": QuarterCarWithEffects.__name__}


def points(name, values):
    return {f"{name}[{i + 1}]": value for i, value in enumerate(values)}


CASES = [
    with_effects("quarter-car-effects", {
        "strut.stribeck.force": 45.0,
        "strut.stribeck.velocity": 0.02,
        "strut.load_dependence.slope": 8.0,
        "strut.yield.force": 30.0,
        "strut.yield.velocity": 0.03,
        "strut.yield.slope": 25.0,
        "strut.knee.ratio": -0.45,
        "strut.knee.velocity": 0.13,
        "strut.orifice.coefficient": 350.0,
        "strut.fade.ratio": 0.4,
        "strut.fade.time": 2.0,
        "strut.spring.quadratic": 4e4,
        "strut.spring.cubic": 3e6,
        "strut.stop.stiffness": 6e4,
        "strut.stop.compression_clearance": 0.0125,
        "strut.stop.rebound_clearance": 0.01,
        "strut.preload": 15.0,
        "strut.linkage.slope": 3.0,
        "strut.curve.scale": 1.5,
        "strut.curve.deflection_range": 0.015,
        **points("strut.curve.over_deflection", [5.0, -3.0, 2.0, 6.0, -4.0, 0.0, 3.0, -7.0, 1.0, 4.0, -2.0]),
        "strut.curve.velocity_range": 0.2,
        **points("strut.curve.over_velocity", [-9.0, -6.0, -8.0, -3.0, -4.0, 0.0, 1.0, 5.0, 4.0, 9.0, 7.0]),
        "guide.damping": 25.0,
        "guide.curve.scale": 1.0,
        "guide.curve.velocity_range": 0.1,
        **points("guide.curve.over_velocity", [-6.0, -5.0, -5.0, -2.0, -1.0, 0.0, 2.0, 2.0, 3.0, 6.0, 8.0]),
        "wheel_guide.damping": 15.0,
        "wheel_guide.coulomb.force": 12.0,
        "wheel_guide.coulomb.velocity": 0.01,
        "tire.curve.scale": 2.0,
        "tire.curve.deflection_range": 0.004,
        **points("tire.curve.over_deflection", [-8.0, -9.0, -3.0, -5.0, -1.0, 0.0, 4.0, 2.0, 6.0, 9.0, 5.0]),
    }, "Every effect without memory at once."),
    with_effects("quarter-car-hysteresis", {
        "hysteresis.presliding.force": 55.0,
        "hysteresis.presliding.stiffness": 1.2e5,
        "hysteresis.presliding.exponent": 1.5,
        "hysteresis.maxwell.stiffness": 1.5e4,
        "hysteresis.maxwell.time": 0.03,
        "hysteresis.mount.gap": 3e-4,
        "hysteresis.mount.compliance": 2e-6,
    }, "Presliding friction, a Maxwell branch and a damper in a bush with backlash."),
    with_effects("quarter-car-play", {
        "strut.coulomb.force": 0.0,
        "hysteresis.presliding.force": 90.0,
        "hysteresis.presliding.stiffness": 1.5e5,
        "hysteresis.presliding.exponent": 0.7,
        "hysteresis.presliding.gap": 4e-4,
    }, "Presliding friction behind backlash."),
]
