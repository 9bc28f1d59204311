"""The instrumentation of the TUM rig, the encoders of Kogut's."""

import math

from cases import single
from sensors import AngleSensorChain, SensorChain, SignalAdapter, VelocityEstimator

# Calibrated, as TUM Tables 1-5 have it. What is assumed says the parameter set.
CONVERTERS = {"body_acceleration": 20.0 / 2**16, "wheel_acceleration": 20.0 / 2**12, "wheel_force": 20.0 / 2**16,
              "actuator_current": 20.0 / 2**12}
SENSORS = {"body_acceleration": (0.8 / 9.80665, 400.0, 4.0), "wheel_acceleration": (0.16 / 9.80665, 1000.0, 4.0),
           "wheel_force": (2e-3, 1000.0, 10.0), "actuator_current": (0.3, 1000.0, 10.0)}
INSTRUMENTS = {"period": 1e-3, "suspension_deflection.density": 12000.0, "suspension_deflection.gain_error": 0.0,
               "suspension_deflection.zero": 0.0, "road_position.density": 1e5, "road_position.gain_error": 0.0,
               "road_position.zero": 0.0}
for name, (sensitivity, bandwidth, full_scale) in SENSORS.items():
    INSTRUMENTS |= {f"{name}.{part}": value for part, value in {
        "sensitivity": sensitivity, "sensor.bandwidth": bandwidth, "sensor.full_scale": full_scale,
        "sensor.gain_error": 0.0, "sensor.offset": 0.0, "filter.corner_frequency": 380.0,
        "converter.range": 10.0, "converter.resolution": CONVERTERS[name], "converter.gain_error": 0.0,
        "converter.offset": 0.0}.items()}
INSTRUMENTS |= {f"{name}.sensor.damping": math.sqrt(0.5) if name.endswith("acceleration") else 0.707
                for name in SENSORS}

QUIET = {f"{name}.noise": 0.0 for name in SENSORS}
ERRORS = {f"{name}.{part}": value for name in SENSORS for part, value in {
    "sensor.gain_error": 0.01, "sensor.offset": 0.12, "converter.gain_error": -0.0025, "converter.offset": 0.005,
    "converter.resolution": 0.0, "sensor.damping": 0.4}.items()}
ENCODERS = {"suspension_deflection.gain_error": 5e-4, "suspension_deflection.zero": 1.3e-4,
            "road_position.density": 0.0, "road_position.zero": 0.002, "road_position.gain_error": -0.01}
# Beyond the full scale of each sensor.
MEASURED = {
    "body.acceleration": {"sines": [[35.0, 1.5, 0.2], [20.0, 11.0, 1.1]], "steps": []},
    "wheel.acceleration": {"sines": [[150.0, 12.0, 0.4], [120.0, 40.0, 0.2]], "steps": [[60.0, 0.1005]]},
    "wheel.force": {"sines": [[3500.0, 9.0, 0.3]], "steps": [[2500.0, 0.0505]]},
    "actuator.current": {"sines": [[20.0, 3.0, 0.5]], "steps": [[20.0, 0.0805]]},
    "suspension.deflection": {"sines": [[0.03, 2.1, 0.7]], "steps": []},
    "road.position": {"sines": [[0.02, 1.7, 0.9]], "steps": []}}


def dynamics(body, wheel, force, current, filtered, rounding):
    kinds = {f"{name}.dynamics": kind for name, kind in zip(SENSORS, (body, wheel, force, current))}
    return kinds | {"filter.enabled": filtered, "encoder.rounding": rounding}


ANGLES = {"eccentric.angle": {"sines": [[3.0, 0.5, 0.2]], "steps": []},
          "wheel_arm.angle": {"sines": [[0.02, 1.35, 0.1]], "steps": [[-0.195, -1.0]]},
          "body_arm.angle": {"sines": [[0.06, 1.35, 1.1]], "steps": [[0.353, -1.0]]}}
COUNTS = {f"{name}.counts_per_turn": 4096.0 for name in AngleSensorChain.encoders}
ENCODED = AngleSensorChain.encoders

CASES = [
    single("sensor-chain", SensorChain, MEASURED, stop=0.3, every=6, package="TumSensorChain",
           parameters=INSTRUMENTS, changed=QUIET,
           settings=dynamics("SecondOrder", "SecondOrder", "FirstOrder", "FirstOrder", True, "Floor"),
           description="Calibrated, without noise. No row's reading is near the edge of a step."),
    single("sensor-chain-errors", SensorChain, MEASURED, stop=0.3, every=6, package="TumSensorChain",
           parameters=INSTRUMENTS, changed=QUIET | ERRORS | ENCODERS | {"period": 2e-3},
           settings=dynamics("FirstOrder", "Direct", "SecondOrder", "Direct", False, "Nearest"),
           description="Every error at work, but no steps in the voltages."),
    single("angle-sensor-chain", AngleSensorChain, ANGLES, stop=1.0, every=2, step=0.01, package="SasSensorChain",
           parameters=COUNTS | {"speed_filter": 0.0, "period": 0.01} | {f"{name}.zero": 0.0 for name in ENCODED},
           settings={"encoder.rounding": "Floor"}, error=1e-12),
    single("angle-sensor-chain-filtered", AngleSensorChain, ANGLES, stop=1.0, every=3, step=5e-3,
           package="SasSensorChain", parameters=COUNTS, settings={"encoder.rounding": "Nearest"}, error=1e-12,
           changed={"speed_filter": 0.04, "eccentric.zero": 0.3, "wheel_arm.counts_per_turn": 0.0, "period": 0.01,
                    "wheel_arm.zero": -0.195, "relative.zero": 0.0}),
    single("velocity-estimator", VelocityEstimator,
           {"body.acceleration": {"sines": [[2.0, 1.5, 0.3], [4.0, 12.0, 0.1]], "steps": [[0.5, 0.2005]]}},
           stop=2.0, every=20, package="TumVelocityEstimator", error=1e-12,
           parameters={"period": 1e-3, "leak_frequency": 0.1, "high_pass_frequency": 0.1}),
    single("velocity-estimator-pure", VelocityEstimator,
           {"body.acceleration": {"sines": [[2.0, 1.5, 0.3]], "steps": []}}, stop=1.0, every=10, error=1e-12,
           package="TumVelocityEstimator",
           changed={"leak_frequency": 0.7, "high_pass_frequency": 0.0, "period": 2e-3}),
    *(single(f"signal-adapter-{operation.lower()}", SignalAdapter,
             {"input": {"sines": [[12.0, 1.5, 0.3], [4.0, 12.0, 0.1]], "steps": [[2.0, 0.2005]]},
              "added": {"sines": [[0.05, 3.1, 0.7]], "steps": []}},
             stop=0.6, every=12, error=1e-12, settings={"operation": operation},
             parameters={"factor": 1.0, "offset": 0.0, "initial": 0.0, "filter": 0.0, "period": 1e-3},
             changed={"factor": -1e-3, "offset": 0.02} | changed)
      for operation, changed in (("Value", {}), ("Derivative", {"filter": 5e-3}),
                                 ("Integral", {"initial": 0.4, "period": 2e-3}), ("Lag", {"filter": 0.02}))),
]
