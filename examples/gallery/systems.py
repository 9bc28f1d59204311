"""What the gallery shows of each system: a sentence, the time from which to which, and two or three panels."""

from dataclasses import dataclass, field

# The colours of a role are the same in all pictures.
ROAD, WHEEL, BODY, FORCE, COMMAND, OTHER = "0.6", "tab:orange", "tab:blue", "tab:red", "0.25", "tab:green"


@dataclass(frozen=True)
class Line:
    """A signal of a panel."""

    signal: str
    label: str
    colour: str
    style: str = "-"


@dataclass(frozen=True)
class Panel:
    """Axes with a quantity; values are multiplied by `scale` for the axis' unit."""

    quantity: str
    scale: float
    lines: list[Line]


@dataclass(frozen=True)
class Picture:
    """A system's picture."""

    system: str
    sentence: str
    stop: float
    panels: list[Panel]
    start: float = 0.0
    # A signal to plot over in place of time, for characteristics.
    over: tuple[str, str, float] | None = None
    parameters: dict = field(default_factory=dict)

    def signals(self):
        lines = [line.signal for panel in self.panels for line in panel.lines]
        return list(dict.fromkeys(lines + ([self.over[0]] if self.over else [])))


def corner(controller, sentence):
    """A car's corner: the three force controllers look alike but in what their force follows."""
    return Picture(
        controller,
        sentence,
        5.0,
        [
            Panel("position in mm", 1e3, [
                Line("road.position", "road", ROAD),
                Line("rig.body.position", "body", BODY),
            ]),
            Panel("force in kN", 1e-3, [
                Line("skyhook.force", "wanted", COMMAND, "--"),
                Line("actuator.force", "actuator", FORCE),
            ]),
        ],
    )


def car(name, sentence):
    """A full car on its random road."""
    return Picture(
        name,
        sentence,
        6.0,
        [
            Panel("position in mm", 1e3, [
                Line("road.front_left.position", "road, front left", ROAD),
                Line("car.heave.position", "heave", BODY),
            ]),
            Panel("angle in °", 57.29577951308232, [
                Line("car.roll.angle", "roll", OTHER),
                Line("car.pitch.angle", "pitch", WHEEL),
            ]),
            Panel("force in kN", 1e-3, [
                Line("actuator_front_left.force", "actuator, front left", FORCE),
            ]),
        ],
    )


def arms(name, sentence, start, stop):
    """The semi-active rig."""
    return Picture(
        name,
        sentence,
        stop,
        [
            Panel("eccentric in mm", 1e3, [Line("drive.height", "height", ROAD)]),
            Panel("angle in °", 57.29577951308232, [
                Line("rig.wheel_arm.angle", "wheel arm", WHEEL),
                Line("rig.body_arm.angle", "body arm", BODY),
            ]),
            Panel("torque in N·m", 1.0, [Line("brake.torque", "brake", FORCE)]),
        ],
        start,
    )


PICTURES = [
    Picture(
        "quanser-lqr",
        "The Quanser rig on its square road: after each edge the body rings, until its regulator is switched on at 5 s.",
        10.0,
        [
            Panel("position in mm", 1e3, [
                Line("road.position", "road", ROAD),
                Line("rig.wheel.position", "wheel", WHEEL),
                Line("rig.body.position", "body", BODY),
            ]),
            Panel("force in N", 1.0, [Line("controller.force", "regulator", FORCE)]),
        ],
    ),
    Picture(
        "tum-active",
        "The TUM rig on a rough road: the linear motor's force stays close to what the skyhook wants.",
        6.0,
        [
            Panel("position in mm", 1e3, [
                Line("road.position", "road", ROAD),
                Line("rig.body.position", "body", BODY),
            ]),
            Panel("force in N", 1.0, [
                Line("controller.force", "wanted", COMMAND, "--"),
                Line("motor.force", "motor", FORCE),
            ]),
        ],
    ),
    Picture(
        "tum-rig",
        "The whole TUM rig: a motor moves the road plate after the profile, and the loop is closed over noisy sensors.",
        4.0,
        [
            Panel("position in mm", 1e3, [
                Line("road.position", "profile", COMMAND, "--"),
                Line("exciter.position", "road plate", ROAD),
                Line("rig.body.position", "body", BODY),
            ]),
            Panel("acceleration in m/s²", 1.0, [
                Line("sensors.measured.body.acceleration", "measured", OTHER),
                Line("rig.body.acceleration", "body", BODY),
            ]),
        ],
    ),
    Picture(
        "tum-strut-dyno",
        "The TUM strut on the bench: a chirp shows friction at rest, and a damper that is stiffer in rebound.",
        20.0,
        [Panel("force in N", 1.0, [Line("dyno.force", "strut", FORCE)])],
        over=("motion.velocity", "velocity of the lower end in m/s", 1.0),
    ),
    Picture(
        "konieczny-open-loop",
        "The AGH rig on a step of 0.1 m: the model from physics beside the one that was identified.",
        4.0,
        [
            Panel("position in mm", 1e3, [
                Line("road.position", "road", ROAD),
                Line("rig.body.position", "body, from physics", BODY),
                Line("identified.body.position", "body, identified", WHEEL, "--"),
            ]),
            Panel("pressure in bar", 1e-5, [
                Line("rig.pressure", "from physics", BODY),
                Line("identified.pressure", "identified", WHEEL, "--"),
            ]),
        ],
    ),
    Picture(
        "konieczny-square-chirp",
        "The same rig on a square wave while a sweep drives its servovalve: body and force follow the voltage until it is too fast.",
        8.0,
        [
            Panel("position in mm", 1e3, [
                Line("road.position", "road", ROAD),
                Line("rig.body.position", "body", BODY),
            ]),
            Panel("voltage in V", 1.0, [Line("source.voltage", "servovalve", COMMAND)]),
            Panel("force in kN", 1e-3, [Line("rig.actuator.force", "actuator", FORCE)]),
        ],
    ),
    Picture(
        "konieczny-apart",
        "Rig and actuator as two FMUs beside both in one: the force that is exchanged follows the one within.",
        8.0,
        [
            Panel("position in mm", 1e3, [
                Line("road.position", "road", ROAD),
                Line("one.body.position", "body, in one", BODY),
                Line("rig.body.position", "body, apart", WHEEL, "--"),
            ]),
            Panel("force in kN", 1e-3, [
                Line("one.actuator.force", "in one", FORCE),
                Line("actuator.force", "apart", COMMAND, "--"),
            ]),
        ],
    ),
    corner(
        "ajala-pid-l",
        "A car's corner under skyhook control, its pump held to the wanted force by a PID of low bandwidth.",
    ),
    corner("ajala-pid-h", "The same corner with a PID of high bandwidth: the body accelerates by a sixth less."),
    corner("ajala-two-dof", "The same corner with two degrees of freedom: an inverse model with weak feedback."),
    car("full-car-passive-soft", "A car at 70 km/h with its pumps locked and soft valves, as a passive car would ride."),
    car("full-car-passive-hard", "The same road with hard valves: heave, roll and pitch are a little smaller."),
    car("full-car-modal-skyhook", "The same road under modal skyhook: the body accelerates by 40 % less than with hard valves."),
    arms(
        "sas",
        "The semi-active rig on a ramp of frequency, the brake without current: the body arm's resonance comes and goes.",
        0.0,
        20.0,
    ),
    arms("sas-30-percent", "At 1.6 Hz with 30 % of the brake's current: the body arm swings by 6.9° from end to end.", 14.0, 18.0),
    arms("sas-70-percent", "With 70 % of the current it swings by 5.4°.", 14.0, 18.0),
    arms("sas-100-percent", "With the full current it swings by 4.8°, and the wheel arm by 1.4° in place of 1.2°.", 14.0, 18.0),
]
