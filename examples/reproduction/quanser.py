"""Quanser Active Suspension, laboratory guide."""

import quanser_lqr
from measure import parameters
from published import missing, taken
from sheet import Claim, Figure, Number, Section

GAINS = {"suspension_deflection": 24.66, "body_velocity": 48.87, "tire_deflection": -0.47, "wheel_velocity": 3.68}


def spoken(gain):
    return gain.replace("_", " ").replace("tire", "tyre")


def section(fmus):
    section = Section("Quanser: linear quadratic regulator")
    section.taken, section.missing = list(taken(fmus, "quanser")), list(missing("quanser"))
    found = parameters(fmus, "QuanserLqrController")
    table = parameters(fmus, "QuanserLqrController", {"tire.stiffness": 1250.0})
    for gain, printed in GAINS.items():
        name = f"gain K on the {spoken(gain)}"
        # The guide cuts digits off instead of rounding: 3.6846 is printed 3.68.
        section.numbers.append(Number(name, "3.1.1", printed, found[f"gain.{gain}"], 0.006))
    rig = parameters(fmus, "QuanserQuarterCar")
    reason = "the printed gain belongs to 2500 N/m"
    section.numbers.append(
        Number("tyre stiffness of the rig that is simulated", "Table 3.1", 1250, rig["tire.stiffness"], 1, "N/m", reason)
    )
    reason = "Table 3.1's K_us = 1250 N/m does not belong to the printed gain; 2500 N/m does"
    for gain in ("body_velocity", "tire_deflection", "wheel_velocity"):
        name = f"the same with Table 3.1's tyre, {spoken(gain)}"
        section.numbers.append(Number(name, "3.1.1", GAINS[gain], table[f"gain.{gain}"], 0.006, reason=reason))

    result, times = quanser_lqr.simulate(fmus), quanser_lqr.measure_settling(fmus)
    passive, active = times["open loop"], times["LQR"]
    section.claims.append(
        Claim(
            "with the regulator the body settles sooner after an edge of the road",
            "3.1.2",
            f"within 5 % in {active:.2f} s instead of {passive:.2f} s",
            active < 0.5 * passive,
        )
    )
    caption = "The rig on the square road; its regulator works from 5 s (Quanser 3.1)"
    section.figures.append(Figure("quanser-lqr.png", caption, lambda: quanser_lqr.plot(result, times)))
    return section
