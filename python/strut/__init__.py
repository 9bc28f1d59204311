"""FMUs of active suspensions, and a diagnosis that finds in measured data what a model lacks.

Quantities are in SI units throughout: m, kg, s, N, rad. Names are those of the FMUs' variables, e.g. ``strut.stiffness``.

>>> import strut
>>> motion = strut.simulate("TumQuarterVehicle", {"strut.stiffness": 9000})
>>> motion["suspension.deflection"].plot()                      # doctest: +SKIP
>>> path = strut.fmu("TumQuarterVehicle", {"strut.stiffness": 9000}, folder="fmus")
>>> strut.check(path).problems
0
"""

from strut._check import Finding, Report, check
from strut._diagnosis import Diagnosis, diagnose, rig, rigs, virtual_records
from strut._models import describe, fmu, models, simulate
from strut._strut import __version__

__all__ = [
    "Diagnosis",
    "Finding",
    "Report",
    "__version__",
    "check",
    "describe",
    "diagnose",
    "fmu",
    "models",
    "rig",
    "rigs",
    "simulate",
    "virtual_records",
]
