"""The single-model cases: what is driven how. Chosen to show every effect of each set."""

from controllers import WEIGHTS, LqrController, Skyhook
from linear_motor import LinearMotor
from parameter_sets import MOTOR, SETS
from quarter_car import QuarterCar
from stimulus import road_sines

# Which FMU a parameter set is.
PACKAGES = {
    "quanser": "QuanserQuarterCar",
    "quanser-table-3-1": "QuanserTable31QuarterCar",
    "konieczny": "KoniecznyQuarterCar",
    "ajala": "AjalaQuarterCar",
    "tum-linear-optimised": "TumLinearOptimisedQuarterCar",
    "tum-linear-measured": "TumLinearMeasuredQuarterCar",
    "tum-table-7-optimised": "TumTable7OptimisedQuarterVehicle",
    "tum-table-7-measured": "TumTable7MeasuredQuarterVehicle",
    "tum-table-10": "TumQuarterVehicle",
}


def single(name, model, inputs, *, stop, every, step=1e-3, package=None, parameters=None, changed=None,
           settings=None, start=None, error=1e-6, description=""):
    """A model driven by held inputs. `parameters` are those of the FMU, `changed` is set on top of them."""
    return {
        "case": name,
        "kind": "single",
        "fmu": model.__name__,
        "package": package or model.__name__,
        "description": description,
        "parameters": parameters or {},
        "changed": changed or {},
        "settings": settings or {},
        "start": start or {},
        "step": step,
        "stop": stop,
        "rows_every": every,
        "inputs": inputs,
        "error": error,
    }


def quarter_car(name, parameter_set, road, force, stop=3.0, start=None, lift_off=False,
                road_steps=(), description=""):
    position, velocity = road_sines(road)
    position["steps"] = [list(step) for step in road_steps]
    sines, steps = force
    inputs = {"road.position": position, "road.velocity": velocity,
              "actuator.force": {"sines": sines, "steps": steps}}
    return single(name, QuarterCar, inputs, stop=stop, every=15, package=PACKAGES[parameter_set],
                  parameters=SETS[parameter_set], settings={"tire.lift_off": lift_off},
                  start=dict(zip(QuarterCar.states, start or [0.0] * 4)), description=description)


def motor(name, voltage, reference, stop, every, description):
    return single(name, LinearMotor, {"voltage": voltage, "force_reference": reference},
                  stop=stop, every=every, parameters=MOTOR, description=description)


RIG_ROAD = [[0.010, 1.3, 0.3], [0.003, 4.7, 1.1], [0.001, 13.1, 2.0]]
RIG_FORCE = ([[120.0, 2.9, 0.5], [60.0, 11.0, 1.7]], [[150.0, 0.9005], [-250.0, 1.9005]])

SMALL_ROAD = [[0.006, 1.1, 0.2], [0.002, 4.3, 0.9], [0.0005, 9.7, 1.6]]
SMALL_FORCE = ([[6.0, 2.3, 0.4], [3.0, 7.9, 1.9]], [[5.0, 0.7005], [-8.0, 1.6005]])

QUARTER_CARS = [
    quarter_car("quarter-car-quanser", "quanser", SMALL_ROAD, SMALL_FORCE,
                road_steps=[[0.005, 2.2005]]),
    quarter_car("quarter-car-quanser-table-3-1", "quanser-table-3-1", SMALL_ROAD, SMALL_FORCE),
    quarter_car("quarter-car-konieczny", "konieczny", RIG_ROAD, RIG_FORCE,
                road_steps=[[0.02, 1.4005]]),
    quarter_car("quarter-car-ajala", "ajala", RIG_ROAD, RIG_FORCE,
                start=[0.01, -0.05, 0.002, 0.1],
                description="Undamped (eq. 27), started away from equilibrium."),
    quarter_car("quarter-car-tum-linear-optimised", "tum-linear-optimised", RIG_ROAD, RIG_FORCE),
    quarter_car("quarter-car-tum-linear-measured", "tum-linear-measured", RIG_ROAD, RIG_FORCE),
    quarter_car("quarter-car-tum-table-7-optimised", "tum-table-7-optimised", RIG_ROAD, RIG_FORCE),
    quarter_car("quarter-car-tum-table-7-measured", "tum-table-7-measured", RIG_ROAD, RIG_FORCE,
                lift_off=True),
    quarter_car("quarter-car-tum-table-10", "tum-table-10", RIG_ROAD, RIG_FORCE, lift_off=True),
    quarter_car("quarter-car-lift-off", "tum-table-10",
                [[0.020, 1.6, 0.3], [0.009, 9.0, 0.7], [0.004, 13.0, 0.2]],
                ([[200.0, 3.1, 0.5]], [[300.0, 1.1005]]), lift_off=True,
                road_steps=[[-0.03, 2.0005]],
                description="The wheel leaves the road and lands again, also by a fall of the road."),
]

MOTORS = [
    motor("linear-motor-response",
          {"sines": [[1.5, 3.0, 0.2], [1.0, 28.7, 0.9], [0.5, 90.0, 0.1]],
           "steps": [[8.0, 0.3005], [-8.0, 0.4005]]},
          {"sines": [[250.0, 7.0, 1.3]], "steps": [[-400.0, 1.2005]]}, 2.0, 10,
          "Both inputs; a short pulse loads the I2t accumulator, which runs empty again."),
    motor("linear-motor-limits",
          {"sines": [], "steps": [[12.0, 0.1005], [-24.0, 2.0005], [12.0, 3.0005]]},
          {"sines": [[300.0, 5.0, 0.0]], "steps": [[3000.0, 3.5005]]}, 4.0, 20,
          "Voltage beyond 10 V; the I2t limiter takes the current from peak to continuous, in both "
          "directions, and gives peak current back after rest."),
]

# The rig that the regulator is made for: Quanser Table 3.1 with the tyre that the printed gain belongs to.
RIG_OF_REGULATOR = {name: SETS["quanser"][name] for name in (
    "sprung_mass", "unsprung_mass", "strut.stiffness", "strut.damping", "tire.stiffness", "tire.damping")}

CASES = QUARTER_CARS + MOTORS + [
    single("lqr", LqrController, {
               "suspension.deflection": {"sines": [[0.01, 6.0, 0.1]], "steps": []},
               "body.velocity": {"sines": [[0.2, 9.0, 0.7]], "steps": []},
               "tire.deflection": {"sines": [[0.004, 21.0, 1.3]], "steps": []},
               "wheel.velocity": {"sines": [[0.5, 15.0, 2.9]], "steps": []}},
           stop=0.2, every=4, package="QuanserLqrController", error=1e-12,
           parameters=RIG_OF_REGULATOR | WEIGHTS | {"period": 1e-3}, changed={"switch_on_time": 0.1}),
    single("skyhook", Skyhook, {"body.velocity": {"sines": [[0.3, 9.0, 0.7]], "steps": [[0.1, 0.0505]]}},
           stop=0.2, every=3, error=1e-12, parameters={"damping": 1500.0}, changed={"period": 2e-3}),
]
