"""Quanser Active Suspension, laboratory guide."""

import quanser_lqr
from measure import parameters
from sheet import Claim, Figure, Number, Section

GAINS = {"suspension_deflection": 24.66, "body_velocity": 48.87, "tire_deflection": -0.47, "wheel_velocity": 3.68}


def section(fmus):
    section = Section("Quanser: linear quadratic regulator")
    found = parameters(fmus, "QuanserLqrController")
    table = parameters(fmus, "QuanserLqrController", {"tire.stiffness": 1250.0})
    for gain, printed in GAINS.items():
        name = f"gain K on the {gain.replace('_', ' ')}"
        # The guide cuts digits off instead of rounding: 3.6846 is printed 3.68.
        section.numbers.append(Number(name, "3.1.1", printed, found[f"gain.{gain}"], 0.006))
    reason = "Table 3.1's K_us = 1250 N/m does not belong to the printed gain; 2500 N/m does"
    for gain in ("body_velocity", "tire_deflection", "wheel_velocity"):
        name = f"the same with Table 3.1's tyre, {gain.replace('_', ' ')}"
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
