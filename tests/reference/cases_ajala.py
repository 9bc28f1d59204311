"""Ajala's actuators. The document gives no values: all are assumed, as the parameter sets say."""

from cases import single
from force_controllers import ForcePid, ForceTwoDof, ForceTwoDofLpv
from pump import PumpHydraulicActuator, PumpHydraulicActuatorLinear
from table import indexed

FLOWS = [-1e-3, -6e-4, -3e-4, -5e-5, 0.0, 5e-5, 3e-4, 6e-4, 1e-3]
CHECK_VALVE = {"Soft": [-1.4e5, -1e5, -0.7e5, -0.4e5, 0.0], "Hard": [-1.9e5, -1.5e5, -1.2e5, -0.85e5, 0.0]}
COMPRESSION = {"Soft": [0.4e5, 1.6e5, 2.7e5, 3.9e5], "Hard": [0.85e5, 3.4e5, 5.7e5, 8.0e5]}
REBOUND = {"Soft": [0.4e5, 3.8e5, 6.7e5, 9.8e5], "Hard": [0.85e5, 8.1e5, 14.2e5, 20.7e5]}

PUMP_AND_GAS = {"pump.displacement": 12e-6, "motor.inertia": 3.3e-4, "gas.charge_pressure": 3e6, "gas.exponent": 1.3,
                "gas.compression_volume": 0.5e-3, "gas.rebound_volume": 0.5e-3}


def valves(setting):
    parameters = {}
    for side, damping in (("compression", COMPRESSION), ("rebound", REBOUND)):
        parameters |= indexed(f"valve.{side}.flow", FLOWS)
        parameters |= indexed(f"valve.{side}.pressure_drop", CHECK_VALVE[setting] + damping[setting])
    return parameters


ACTUATOR = {setting: PUMP_AND_GAS | {"piston.compression_area": 10.2e-4, "piston.rebound_area": 8.6e-4}
            | valves(setting) for setting in CHECK_VALVE}
ACTUATOR_LINEAR = PUMP_AND_GAS | {"piston.area": 9.4e-4, "valve.compression_resistance": 8e8,
                                  "valve.rebound_resistance": 8e8}

# Up to 1.3 m/s: beyond the ends of the valves' tables.
DRIVEN = {"motor.torque": {"sines": [[1.5, 1.7, 0.3], [0.8, 9.0, 1.0]], "steps": [[2.0, 0.6005], [-3.0, 1.2005]]},
          "suspension.velocity": {"sines": [[0.7, 2.3, 0.2], [0.4, 11.0, 1.4]], "steps": [[-0.2, 0.9005]]}}
OPTIONS = {"step": 2e-3, "stop": 2.0, "every": 8}

CASES = [
    single("pump-actuator", PumpHydraulicActuator, DRIVEN, **OPTIONS, package="AjalaSoftPumpHydraulicActuator",
           parameters=ACTUATOR["Soft"], settings={"pump.locked": False},
           start={"motor.speed": 30.0, "overpressure.compression": 2e5, "overpressure.rebound": -1e5},
           description="Soft valves, beyond the ends of their tables; started away from rest."),
    single("pump-actuator-locked", PumpHydraulicActuator, DRIVEN, **OPTIONS, package="AjalaHardPumpHydraulicActuator",
           parameters=ACTUATOR["Hard"], settings={"pump.locked": True}, start={"motor.speed": 5.0},
           description="Hard valves, the pump held: the passive actuator, but for the speed that is held."),
    single("pump-actuator-losses", PumpHydraulicActuator, DRIVEN, **OPTIONS, package="AjalaSoftPumpHydraulicActuator",
           parameters=ACTUATOR["Soft"], settings={"pump.locked": False},
           changed={"pump.leakage": 2e-11, "pump.coulomb.torque": 0.3, "pump.coulomb.speed": 3.0},
           start={"motor.speed": 30.0, "overpressure.compression": 2e5, "overpressure.rebound": -1e5},
           description="The same with a pump that leaks and rubs."),
    single("pump-actuator-leak", PumpHydraulicActuator, DRIVEN, **OPTIONS, package="AjalaHardPumpHydraulicActuator",
           parameters=ACTUATOR["Hard"], settings={"pump.locked": True}, changed={"pump.leakage": 1e-11},
           start={"overpressure.compression": 4e5},
           description="Hard valves and a pump that is held and leaks."),
    single("pump-actuator-linear", PumpHydraulicActuatorLinear, DRIVEN, **OPTIONS,
           package="AjalaPumpHydraulicActuatorLinear", parameters=ACTUATOR_LINEAR, settings={"pump.locked": False},
           start={"motor.speed": -20.0, "pressure.difference": 1e5}),
    single("pump-actuator-linear-locked", PumpHydraulicActuatorLinear, DRIVEN, **OPTIONS,
           package="AjalaPumpHydraulicActuatorLinear", parameters=ACTUATOR_LINEAR, settings={"pump.locked": True},
           start={"motor.speed": -5.0}),
]

MOTOR = {"torque.limit": 8.0, "period": 1e-3, "pump.displacement": 12e-6}
PID_H = MOTOR | {"piston.area": 9.4e-4, "gain.proportional": 8.0, "gain.integral": 100.0, "gain.derivative": 0.025,
                 "gain.derivative_lag": 4e-3}
PID_L = PID_H | {"gain.proportional": 0.1, "gain.integral": 28.0, "gain.derivative": 0.02, "gain.derivative_lag": 3e-3}
TWO_DOF = MOTOR | {
    "piston.area": 9.4e-4, "plant.stiffness": 13784.16, "plant.damping": 1413.76, "disturbance.cut_off": 2.0,
    "force.proportional": 5e-5, "force.integral": 1.5e-5, "velocity.proportional": 24e3, "velocity.integral": 960e3,
    "velocity.derivative": 0.0, "velocity.derivative_lag": 2e-3}
LPV = MOTOR | ACTUATOR["Soft"] | {
    "disturbance.cut_off": 2.0, "force.proportional": 0.025, "force.integral": 0.0075, "speed.proportional": 0.1,
    "speed.integral": 4.0, "speed.derivative": 0.0, "speed.derivative_lag": 2e-3}
del LPV["motor.inertia"]

# References beyond what the torque limit holds (3.9 kN), in both directions.
SIGNALS = {
    "force_reference": {"sines": [[900.0, 1.3, 0.2], [300.0, 6.1, 0.9]], "steps": [[6000.0, 0.3005], [-11000.0, 0.5005],
                                                                                   [5000.0, 0.6505]]},
    "actuator.force": {"sines": [[700.0, 1.3, -0.4], [250.0, 13.0, 0.1]], "steps": [[500.0, 0.4005]]},
    "suspension.deflection": {"sines": [[0.03, 1.7, 0.3], [0.004, 12.0, 0.6]], "steps": [[0.01, -1.0]]},
    "suspension.velocity": {"sines": [[0.5, 1.7, 1.9], [0.3, 12.0, 2.2]], "steps": []},
    "motor.speed": {"sines": [[60.0, 1.7, 0.7], [40.0, 9.0, 0.5]], "steps": []},
    "pressure.compression": {"sines": [[1.2e6, 1.7, 0.1]], "steps": [[3e6, -1.0], [-2.5e6, 0.7505]]},
    "pressure.rebound": {"sines": [[1.4e6, 1.7, 3.1]], "steps": [[3e6, -1.0]]}}


def controller(name, model, package, parameters, changed=None, order=None):
    settings = {} if order is None else {"disturbance.order": order}
    return single(name, model, {name: SIGNALS[name] for name in model.inputs}, stop=0.9, every=7, error=1e-12,
                  package=package, parameters=parameters, changed=changed, settings=settings)


CASES += [
    controller("force-pid-h", ForcePid, "AjalaPidHForcePid", PID_H),
    controller("force-pid-l", ForcePid, "AjalaPidLForcePid", PID_L, {"period": 2e-3}),
    controller("force-two-dof", ForceTwoDof, "AjalaForceTwoDof", TWO_DOF, order=2),
    controller("force-two-dof-order-3", ForceTwoDof, "AjalaForceTwoDof", TWO_DOF,
               {"disturbance.cut_off": 3.0, "velocity.derivative": 20.0, "period": 2e-3}, order=3),
    controller("force-two-dof-lpv", ForceTwoDofLpv, "AjalaForceTwoDofLpv", LPV, order=2),
    controller("force-two-dof-lpv-order-1", ForceTwoDofLpv, "AjalaForceTwoDofLpv", LPV,
               {"speed.derivative": 1e-4}, order=1),
]
