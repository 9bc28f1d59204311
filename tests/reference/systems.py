"""The connected systems that have a reference."""

from cases_ajala import ACTUATOR_LINEAR, TWO_DOF
from cases_kogut import BRAKE, DRIVE, SPEED_CONTROLLER
from cases_kogut import RIG as SAS
from cases_konieczny import RIG as SERVO
from controllers import WEIGHTS, LqrController, Skyhook
from coupled import System
from eccentric import EccentricDrive, ExcitationSpeedController
from force_controllers import ForceTwoDof
from linear_motor import LinearMotor
from parameter_sets import SETS
from pump import PumpHydraulicActuatorLinear
from quarter_car import QuarterCar
from roads import Road
from sas import MrRotaryBrake, SasRig
from servo import ServoSuspension, ServoSuspensionIdentified
from sources import FrequencySource

ROAD = [("road.position", "rig.road.position"), ("road.velocity", "rig.road.velocity")]


def system(name, components, connections, order, *, stop, step=1e-3, every=25, jumps=(), hidden=(), start=None,
           description=""):
    """`jumps` are times where a signal has two values; `hidden` are signals that are no columns; `start` are states
    that do not begin at zero."""
    return {"case": name, "kind": "coupled", "description": description, "step": step, "stop": stop,
            "rows_every": every, "connections": [list(pair) for pair in connections], "jumps": list(jumps),
            "ticked": [f"{part}.{output}" for part, model in components.items() if getattr(model, "period", None)
                       for output in model.outputs]}, System(components, connections, order), hidden, start


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


class ClosedServoSuspension(ServoSuspension):
    """Its valve stays closed: on which side of it the spool is does not matter."""

    def watched(self, _mode):
        return []


def konieczny_open_loop():
    components = {
        "road": Road({"step.height": 0.1, "edge_time": 0.05, "start_time": 0.5}, {"kind": "Step"}),
        "rig": ClosedServoSuspension(SERVO, {"actuator.law": "Nonlinear"}),
        "identified": ServoSuspensionIdentified({"length_unit": 1e-3, "pressure_unit": 1e5, "power_unit": 1e5}),
    }
    connections = ROAD + [("road.position", "identified.road.position")]
    return system("konieczny-open-loop", components, connections, ["rig", "identified"], stop=2.0,
                  hidden=["rig.wheel.undamped_velocity", *NOTHING_FLOWS],
                  description="Konieczny 4, Fig. 9: a step of the road of 0.1 m, the valve closed; from physics and "
                              "as identified.")


# The valve is closed, and the identified power decays from nothing: what stays zero has no scale.
NOTHING_FLOWS = ["rig.spool.position", "rig.supply.flow", "rig.supply.power", "identified.supply.power"]


def ajala_two_dof():
    components = {
        "road": Road({"speed": 70.0 / 3.6, "start_time": 0.5}, {"kind": "Iso8608", "iso_class": "C", "seed": 1}),
        "rig": QuarterCar(SETS["ajala"]),
        "skyhook": Skyhook({"damping": 3000.0, "period": 1e-3}),
        "controller": ForceTwoDof(TWO_DOF, {"disturbance.order": 2}),
        "actuator": PumpHydraulicActuatorLinear(ACTUATOR_LINEAR, {"pump.locked": False}),
    }
    connections = ROAD + [
        ("rig.body.velocity", "skyhook.body.velocity"),
        ("skyhook.force", "controller.force_reference"),
        ("actuator.force", "controller.actuator.force"),
        ("rig.suspension.deflection", "controller.suspension.deflection"),
        ("actuator.motor.speed", "controller.motor.speed"),
        ("controller.motor.torque", "actuator.motor.torque"),
        ("rig.suspension.velocity", "actuator.suspension.velocity"),
        ("actuator.force", "rig.actuator.force"),
    ]
    # The rig's velocities, the actuator's force, then what the rig makes of it.
    return system("ajala-two-dof", components, connections, ["rig", "actuator", "rig"], stop=3.0, jumps=[0.5],
                  description="Ajala 3.2: skyhook over force control with two degrees of freedom, on ISO 8608 class C "
                              "at 70 km/h. The force controller sees what the skyhook has left a tick before.")


def sas():
    components = {
        "source": FrequencySource({"offset": 0.0, "start_time": 0.0, "ramp.rate": 0.1, "ramp.duration": 20.0},
                                  {"shape": "Ramp"}),
        "controller": ExcitationSpeedController(SPEED_CONTROLLER),
        "drive": EccentricDrive(DRIVE, {"pwm.bits": 8}),
        "rig": SasRig(SAS, {"wheel_arm.locked": False, "spring.lever": "Printed", "tire.lift_off": False}),
        "brake": MrRotaryBrake(BRAKE, {"pwm.bits": 8}),
    }
    connections = [
        ("source.frequency", "controller.frequency_reference"),
        ("drive.angle", "controller.eccentric.angle"),
        ("drive.speed", "controller.eccentric.speed"),
        ("controller.duty", "drive.duty"),
        ("drive.height", "rig.eccentric.height"),
        ("drive.velocity", "rig.eccentric.velocity"),
        ("rig.tire.force", "drive.tire.force"),
        ("rig.relative.speed", "brake.relative.speed"),
        ("brake.torque", "rig.brake.torque"),
    ]
    wheel, body = components["rig"].rest()
    return system("sas", components, connections, ["drive", "rig", "brake", "rig", "drive"], stop=10.0, every=50,
                  hidden=["brake.field"], start={"rig.wheel_arm.angle": wheel, "rig.body_arm.angle": body},
                  description="Kogut 3.2.2: the semi-active rig on a ramp of frequency, 0.1 Hz/s.")


SYSTEMS = {"tum-active": tum_active, "sas": sas, "ajala-two-dof": ajala_two_dof, "quanser-lqr": quanser_lqr,
           "konieczny-open-loop": konieczny_open_loop}


def solve(name, solver):
    """Columns, rows and remarks of a system."""
    case, model, hidden, start = SYSTEMS[name]()
    rows, modes = model.run(case["stop"], case["step"], case["rows_every"], solver, start)
    names = ["time", *model.names]
    chosen = [index for index, column in enumerate(names) if column not in hidden]
    return ([names[i] for i in chosen], [[row[i] for i in chosen] for row in rows], {"ticks_by_mode": modes})
