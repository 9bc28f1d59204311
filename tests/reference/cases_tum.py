"""The excitation motor of the TUM rig."""

from cases import single
from excitation import ExcitationMotor

# Peak and continuous force and the peak's duration are TUM's (3.2.1), the rest is assumed as the parameter set says.
EXCITATION = {
    "moving_mass": 16.0, "guide.coulomb.force": 10.0, "guide.coulomb.velocity": 0.008, "guide.damping": 3.7,
    "base_spring.stiffness": 4000.0, "constant_load": 0.0, "force_offset": 0.0, "force_constant": 93.0,
    "resistance": 12.7, "inductance": 0.016, "voltage_limit": 329.0, "peak_current": 20.0,
    "continuous_current": 276.0 / 93.0, "peak_time": 1.0, "fade": 0.02, "stroke_limit": 0.06, "speed_limit": 3.0,
    "dead_zone": 5e-5, "profile.velocity_limit": 2.6, "profile.acceleration_limit": 80.0, "profile.pole": 1000.0,
    "feed_forward.velocity": 1.0, "feed_forward.acceleration": 0.002, "position_loop.gain": 80.0,
    "velocity_loop.command_filter": 600.0, "velocity_loop.proportional": 86.0, "velocity_loop.integral": 2700.0,
    "velocity_loop.output_filter": 600.0, "current_loop.proportional": 60.0, "current_loop.integral": 48000.0}

REST = {"sines": [], "steps": []}
LOADS = {"load.force": {"sines": [[40.0, 1.7, 0.2]], "steps": [[30.0, 0.5]]},
         "wheel.force": {"sines": [[160.0, 12.0, 0.6]], "steps": []}}


def excitation(name, drive, command, changed, stop=0.9, description=""):
    inputs = {f"command.{what}": command.get(what, REST) for what in ("position", "force", "voltage")} | LOADS
    return single(name, ExcitationMotor, inputs, stop=stop, every=6, step=2e-3, package="TumExcitationMotor",
                  parameters=EXCITATION, settings={"drive": drive}, changed=changed, description=description)


CASES = [
    excitation("excitation-motor", "Position",
               {"position": {"sines": [[0.015, 3.0, 0.0], [0.002, 14.0, 0.3]],
                             "steps": [[0.07, 0.3005], [-0.12, 0.5005]]},
                "force": {"sines": [[20.0, 5.0, 0.0]], "steps": []}},
               {"profile.velocity_limit": 1.2, "peak_time": 0.15, "force_offset": 15.0, "constant_load": 12.0},
               description="Beyond the stroke, at the profile's limits, into the overload."),
    excitation("excitation-motor-force", "Force",
               {"force": {"sines": [[500.0, 4.0, 0.1]], "steps": [[2200.0, 0.3005], [-2600.0, 0.4505]]}},
               {"peak_time": 0.1}, stop=1.0),
    excitation("excitation-motor-voltage", "Voltage",
               {"voltage": {"sines": [[60.0, 6.0, 0.2]], "steps": [[400.0, 0.3005], [-420.0, 0.3255]]}}, {},
               stop=0.8),
]
