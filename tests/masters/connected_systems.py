"""The connected systems: composed as in the examples or as their files have them, and their reference solutions."""

import json
import sys
from pathlib import Path

import numpy as np
from fmpy_references import REFERENCE, load

sys.path.insert(0, str(Path(__file__).parent.parent.parent / "examples"))
import quanser_lqr  # noqa: E402
import tum_active  # noqa: E402
from jacobi import System  # noqa: E402
from ssp import open_system  # noqa: E402

COMPOSED = {"quanser-lqr": quanser_lqr, "tum-active": tum_active}
# All that have a reference as a whole.
REFERENCED = [
    path.stem
    for path in sorted((REFERENCE / "cases").glob("*.json"))
    if json.loads(path.read_text(encoding="utf-8"))["kind"] == "coupled"
]
# What the examples change in an FMU, as the system's file does. The road and the rig are as they come.
PARAMETERS = {"quanser-lqr": {"controller.switch_on_time": 5.0}, "tum-active": {}}


class Reference:
    """A monolithic solution: no exchange, hence no coupling error."""

    def __init__(self, name):
        self.case, rows = load(REFERENCE / "cases" / f"{name}.json")
        self.stop, self.step = self.case["stop"], self.case["step"]
        # The first row is the initial state. Where a signal jumps, the reference has what holds after the jump, and
        # a master what held in the step that arrives there.
        rows = rows[(np.abs(rows[:, :1] - [0.0, *self.case["jumps"]]) > 1e-9).all(axis=1)]
        self.times = rows[:, 0]
        self.signals = self.case["columns"][1:]
        self.values = {name: rows[:, index] for index, name in enumerate(self.signals, 1)}

    def scaled(self, name, difference):
        """The largest difference, relative to the signal's scale."""
        return float(np.abs(difference).max() / self.case["scale"][name])

    def at_rows(self, result, step):
        """A result with a row every step, at the reference's times.

        What a sampled component puts out is looked at one step later: the reference has it after the tick at t_k,
        a master gets to see that tick's output at the end of the step that begins at t_k.
        """
        index = np.rint(self.times / step).astype(int)
        # `time` of a row is the master's own, added up by some.
        assert np.allclose(result["time"][index], self.times, rtol=0, atol=1e-9)
        signals = [name for name in self.signals if name in result]
        return {name: result[name][index + (name in self.case["ticked"])] for name in signals}


def compose(name, folder, kind=System, parameters=None):
    if name not in COMPOSED:
        return open_system(folder, name, parameters, kind)
    module = COMPOSED[name]
    return kind(folder, module.COMPONENTS, module.CONNECTIONS, PARAMETERS[name] | (parameters or {}))
