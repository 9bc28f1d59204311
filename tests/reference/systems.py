"""The connected systems that have a reference."""

from controllers import WEIGHTS, LqrController, Skyhook
from coupled import System
from linear_motor import LinearMotor
from parameter_sets import SETS
from quarter_car import QuarterCar
from roads import Road

ROAD = [("road.position", "rig.road.position"), ("road.velocity", "rig.road.velocity")]


def system(name, components, connections, order, *, stop, step=1e-3, every=25, jumps=(), hidden=(), description=""):
    """`jumps` are times where a signal has two values; `hidden` are signals that are no columns."""
    return {"case": name, "kind": "coupled", "description": description, "step": step, "stop": stop,
            "rows_every": every, "connections": [list(pair) for pair in connections], "jumps": list(jumps),
            "ticked": [f"{part}.{output}" for part, model in components.items() if getattr(model, "period", None)
                       for output in model.outputs]}, System(components, connections, order), hidden


def quanser_lqr():
    rig = SETS["quanser"]
    components = {
        "road": Road({"amplitude": 0.01, "frequency": 0.3, "edge_time": 0.02}, {"kind": "Square"}),
        "rig": QuarterCar(rig),
        "controller": LqrController(rig | WEIGHTS | {"period": 1e-3, "switch_on_time": 5.0}),
    }
    measured = LqrController.inputs
    connections = ROAD + [(f"rig.{name}", f"controller.{name}") for name in measured] + [
        ("controller.force", "rig.actuator.force")]
    return system("quanser-lqr", components, connections, ["rig"], stop=10.0, jumps=[5.0],
                  description="Quanser 3.1.1: square road, LQR switched on at 5 s. The K_us = 2500 set.")


def tum_active():
    components = {
        "road": Road({"speed": 10.0, "start_time": 0.5}, {"kind": "Iso8608", "iso_class": "D", "seed": 1}),
        "rig": QuarterCar(SETS["tum-table-10"], {"tire.lift_off": True}),
        "controller": Skyhook({"damping": 1500.0, "period": 1e-3}),
        "motor": LinearMotor(),
    }
    connections = ROAD + [
        ("rig.body.velocity", "controller.body.velocity"),
        ("controller.force", "motor.force_reference"),
        ("motor.force", "rig.actuator.force"),
    ]
    return system("tum-active", components, connections, ["motor", "rig"], stop=10.0, jumps=[0.5],
                  hidden=[f"motor.{name}" for name in LinearMotor.states],
                  description="TUM Table 10 rig with its linear motor, Skyhook (Ajala eq. 28) on the body "
                              "velocity, ISO 8608 class D road. The road's velocity jumps at its start.")


SYSTEMS = {"tum-active": tum_active, "quanser-lqr": quanser_lqr}


def solve(name, solver):
    """Columns, rows and remarks of a system."""
    case, model, hidden = SYSTEMS[name]()
    rows, modes = model.run(case["stop"], case["step"], case["rows_every"], solver)
    names = ["time", *model.names]
    chosen = [index for index, column in enumerate(names) if column not in hidden]
    return ([names[i] for i in chosen], [[row[i] for i in chosen] for row in rows], {"ticks_by_mode": modes})
