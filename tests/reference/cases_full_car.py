"""The full car and its controller."""

from cases import single
from controllers import ModalSkyhook
from full_car import CORNERS, FullCar
from parameter_sets import ASYMMETRY, V0

# Ajala gives no values: a mid-size car, four times the quarter car (assumed).
BODY = {"sprung_mass": 1400.0, "roll_inertia": 500.0, "pitch_inertia": 2300.0}
GEOMETRY = {"geometry.front": 1.35, "geometry.rear": 1.35, "geometry.left": 0.78, "geometry.right": 0.78}
# Half the load on the left rear wheel, and no two lengths alike.
LOPSIDED = {"geometry.front": 1.1, "geometry.rear": 1.55, "geometry.left": 0.85, "geometry.right": 0.7}


def axle(name, unsprung, strut, tire, bar=0.0):
    """All parameters of an axle; those not given are neutral."""
    strut = {"stiffness": 20000.0, "damping": 0.0, "asymmetry.ratio": 0.0, "asymmetry.smoothing": 0.005,
             "coulomb.force": 0.0, "coulomb.velocity": V0} | strut
    tire = {"stiffness": 290000.0, "quadratic": 0.0, "damping": 0.0, "coulomb.force": 0.0,
            "coulomb.velocity": V0} | tire
    return ({f"unsprung_mass.{name}": unsprung, f"anti_roll_bar.{name}.stiffness": bar}
            | {f"{element}.{name}_{side}.{key}": value for side in ("left", "right")
               for element, own in (("strut", strut), ("tire", tire)) for key, value in own.items()})


LINEAR = BODY | GEOMETRY | axle("front", 36.0, {}, {}) | axle("rear", 36.0, {}, {})

# Smoother than the published rigs: what is sharp at a corner of four takes long to integrate.
SMOOTH = {"asymmetry.smoothing": 0.03, "coulomb.velocity": 0.03}

EFFECTS = BODY | LOPSIDED | axle(
    "front", 42.0,
    {"stiffness": 22000.0, "damping": 1500.0, "asymmetry.ratio": ASYMMETRY, "coulomb.force": 90.0} | SMOOTH,
    {"stiffness": 210000.0, "quadratic": 2.1e6, "damping": 80.0, "coulomb.force": 40.0, "coulomb.velocity": 0.03},
    bar=15000.0) | axle(
    "rear", 37.0,
    {"stiffness": 18000.0, "damping": 1300.0, "asymmetry.ratio": -0.2, "coulomb.force": 60.0} | SMOOTH,
    {"stiffness": 190000.0, "quadratic": 1.4e6, "damping": 50.0}, bar=8000.0)


def driven(road, force, fall=()):
    """Roads and forces that differ from corner to corner in phase."""
    inputs = {}
    for i, corner in enumerate(CORNERS):
        sines = [[a, f, phi + 0.9 * i] for a, f, phi in road]
        steps = [[height, at] for height, at, where in fall if where == corner]
        inputs[f"road.{corner}.position"] = {"sines": sines, "steps": steps}
        inputs[f"road.{corner}.velocity"] = {"sines": [[6.283 * f * a, f, phi + 1.5708] for a, f, phi in sines],
                                             "steps": []}
        inputs[f"actuator.{corner}.force"] = {"sines": [[force, 2.1 + 0.7 * i, 0.4 * i]], "steps": [[force, 0.7005]]}
    return {name: inputs[name] for name in FullCar.inputs}


CASES = [
    single("full-car", FullCar, driven([[0.008, 1.2, 0.1], [0.002, 7.3, 0.5]], 300.0), stop=1.5, every=5,
           step=2e-3, package="AjalaFullCar", parameters=LINEAR, settings={"tire.lift_off": False},
           start={"heave.position": 0.01, "roll.speed": 0.1, "pitch.angle": -0.01, "wheel.rear_left.velocity": 0.2},
           description="Undamped, as Ajala Fig. 7 has it; started away from equilibrium."),
    single("full-car-effects", FullCar,
           driven([[0.020, 1.2, 0.1], [0.010, 9.0, 0.5]], 800.0, [[-0.04, 0.9005, "rear_left"]]), stop=1.5, every=5,
           step=2e-3, changed=EFFECTS, settings={"tire.lift_off": True},
           description="No corner like another, every effect of struts and tyres, anti-roll bars; wheels leave the "
                       "road and land."),
    single("modal-skyhook", ModalSkyhook, {
               "heave.velocity": {"sines": [[0.3, 1.3, 0.2]], "steps": []},
               "roll.speed": {"sines": [[0.2, 2.1, 0.7]], "steps": [[0.1, 0.2505]]},
               "pitch.speed": {"sines": [[0.1, 3.7, 1.9]], "steps": []}},
           stop=0.5, every=7, error=1e-12, package="AjalaModalSkyhook",
           parameters={"damping.heave": 12000.0, "damping.roll": 7300.0, "damping.pitch": 21870.0, "period": 1e-3},
           changed=LOPSIDED),
]
