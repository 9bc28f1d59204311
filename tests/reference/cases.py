"""The single-model cases: what is driven how. Chosen to show every effect of each set."""

from models import LinearMotor, QuarterCar
from parameter_sets import MOTOR, SETS
from stimulus import road_sines

SAMPLING = ("inputs hold value(t_k) on [t_k, t_k + step]; the row at t_k > 0 is read at the end "
            "of the step that arrives at t_k, before new inputs are set; the row at 0 with the input at 0")


def quarter_car(name, parameter_set, road, force, stop=3.0, start=None, lift_off=False,
                road_steps=(), description=""):
    position, velocity = road_sines(road)
    position["steps"] = [list(step) for step in road_steps]
    sines, steps = force
    return {
        "case": name,
        "kind": "single",
        "fmu": "QuarterCar",
        "description": description,
        "parameter_set": parameter_set,
        "parameters": SETS[parameter_set],
        "settings": {"tire.lift_off": lift_off},
        "start": dict(zip(QuarterCar.states, start or [0.0] * 4)),
        "step": 1e-3,
        "stop": stop,
        "rows_every": 15,
        "inputs": {"road.position": position, "road.velocity": velocity,
                   "actuator.force": {"sines": sines, "steps": steps}},
        "states": QuarterCar.states,
        "outputs": QuarterCar.outputs,
        "sampling": SAMPLING,
    }


def motor(name, voltage, reference, stop, every, description):
    return {
        "case": name,
        "kind": "single",
        "fmu": "LinearMotor",
        "description": description,
        "parameters": MOTOR,
        "settings": {},
        "start": dict.fromkeys(LinearMotor.states, 0.0),
        "step": 1e-3,
        "stop": stop,
        "rows_every": every,
        "inputs": {"voltage": voltage, "force_reference": reference},
        "states": LinearMotor.states,
        "outputs": LinearMotor.outputs,
        "sampling": SAMPLING,
    }


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

SINGLE = QUARTER_CARS + MOTORS

ROADS = [
    {"case": f"road-{kind.replace('_', '-')}", "kind": "road", "fmu": "Road", "road_kind": kind,
     "parameters": parameters, "stop": stop, "rows": rows,
     "sampling": "road.position and road.velocity at the row's time; no row stands on an edge"}
    for kind, parameters, stop, rows in [
        ("sine", {"amplitude": 0.005, "frequency": 1.7, "start": 0.25}, 3.0, 60),
        ("square", {"amplitude": 0.01, "frequency": 0.3, "edge_time": 0.02, "start": 0.0}, 6.0, 90),
        ("step", {"amplitude": 0.1, "edge_time": 0.05, "start": 0.5}, 1.5, 60),
        ("chirp", {"amplitude": 0.0015, "start_frequency": 1.0, "end_frequency": 8.0,
                   "duration": 25.0, "start": 0.0}, 30.0, 120),
        ("frequency_ramp", {"amplitude": 0.0025, "rate": 0.1, "start": 0.0}, 40.0, 120),
        ("bump", {"height": 0.08, "length": 1.2, "speed": 5.0, "start": 0.5}, 1.5, 60),
        ("iso8608", {"road_class": "D", "speed": 10.0, "seed": 1, "start": 0.5}, 20.0, 150),
    ]
] + [
    {"case": "road-iso8608-class-a", "kind": "road", "fmu": "Road", "road_kind": "iso8608",
     "parameters": {"road_class": "A", "speed": 25.0, "seed": 20260101, "start": 0.0},
     "stop": 10.0, "rows": 60,
     "sampling": "road.position and road.velocity at the row's time"},
]

CONTROLLERS = [
    {"case": "lqr-static", "kind": "static", "fmu": "LqrController", "step": 1e-3, "stop": 0.2,
     "rows_every": 4, "law": "force = -K x from t = switch_on_time on, else 0",
     "parameter_set": "quanser", "switch_on_time": 0.1,
     "sampling": "the force at t_k follows from the inputs at t_k",
     "inputs": {"suspension.deflection": {"sines": [[0.01, 6.0, 0.1]], "steps": []},
                "body.velocity": {"sines": [[0.2, 9.0, 0.7]], "steps": []},
                "tire.deflection": {"sines": [[0.004, 21.0, 1.3]], "steps": []},
                "wheel.velocity": {"sines": [[0.5, 15.0, 2.9]], "steps": []}},
     "outputs": ["force"]},
    {"case": "skyhook-static", "kind": "static", "fmu": "Skyhook", "step": 1e-3, "stop": 0.2,
     "rows_every": 4, "law": "force = -damping body.velocity (Ajala eq. 28)", "damping": 1500.0,
     "sampling": "the force at t_k follows from the inputs at t_k",
     "inputs": {"body.velocity": {"sines": [[0.3, 9.0, 0.7]], "steps": [[0.1, 0.0505]]}},
     "outputs": ["force"]},
]
