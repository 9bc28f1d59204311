"""FMUs: what there is, making them, simulating them."""

from __future__ import annotations

import json
import numbers
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from strut import _strut
from strut._command import FOLDER
from strut._frames import columns

Value = float | int | bool | str
"""A parameter's value: a number in the parameter's SI unit, a switch, or the name of an enumeration's item."""


def models() -> pd.DataFrame:
    """All FMUs and systems of FMUs, one a row: name, kind, numbers of inputs and outputs, title.

    >>> strut.models().loc["TumQuarterVehicle", "kind"]
    'rig'
    """
    listed = json.loads(_strut.models(_libraries()))
    return pd.DataFrame(listed).set_index("name")


def describe(name: str) -> dict[str, Any]:
    """Variables with units, bounds and sources, equations and notes of an FMU; components and connections of a system.

    >>> variables = strut.describe("TumQuarterVehicle")["variables"]
    >>> next(it["unit"] for it in variables if it["name"] == "strut.stiffness")
    'N/m'
    """
    return json.loads(_strut.describe(name, _libraries()))


def fmu(
    model: str,
    parameters: Mapping[str, Value] | None = None,
    *,
    name: str | None = None,
    folder: str | os.PathLike[str] = ".",
) -> Path:
    """Makes an FMU (FMI 2.0, co-simulation and model exchange) and returns its path.

    The library in it is a prebuilt one, so that this takes less than a second and needs no compiler.

    :param model: A name of :func:`models`, e.g. ``"TumQuarterVehicle"``.
    :param parameters: Values that differ from the published ones, in SI units (N/m, N.s/m, kg …).
    :param name: Another name for the FMU: letters, digits and ``_``.
    :param folder: Where it is written; made if it is missing.
    :raises ValueError: If there is no such FMU or parameter, or a value is out of its bounds.

    >>> strut.fmu("TumQuarterVehicle", {"strut.stiffness": 9000}, name="StiffRig", folder="fmus").name
    'StiffRig.fmu'
    """
    return _strut.fmu(model, _values(parameters), name, os.fspath(folder), _libraries())


def simulate(
    model: str,
    parameters: Mapping[str, Value] | None = None,
    *,
    inputs: Any = None,
    stop_time: float | None = None,
    step_size: float | None = None,
) -> pd.DataFrame:
    """Simulates an FMU's model, with error control: its driven inputs and all outputs over the time in s.

    Without ``inputs``, they do what they do in the FMU's default experiment, e.g. a step of the road.

    :param model: A name of :func:`models`.
    :param parameters: Values that differ from the published ones, in SI units.
    :param inputs: A frame (pandas, polars) or a mapping of columns: ``time`` in s and inputs in SI units. Straight
        lines between the points.
    :param stop_time: End in s; default: that of the experiment, or of ``inputs``.
    :param step_size: Distance of the rows in s; default: that of the experiment.
    :returns: A frame; ``.attrs["units"]`` holds the columns' units.
    :raises ValueError: If there is no such FMU, parameter or input, or the integration fails.

    >>> motion = strut.simulate("TumQuarterVehicle", stop_time=1.0)
    >>> motion.attrs["units"]["body.acceleration"]
    'm/s2'
    """
    given = None
    if inputs is not None:
        given = _inputs(inputs, model)
        if stop_time is None:
            stop_time = float(np.frombuffer(given[0][1])[-1])
    time, signals = _strut.simulate(model, _values(parameters), given, step_size, stop_time, _libraries())
    frame = pd.DataFrame(
        {name: np.frombuffer(values) for name, _, values in signals},
        index=pd.Index(np.frombuffer(time), name="time"),
    )
    frame.attrs["units"] = {name: unit for name, unit, _ in signals}
    return frame


def _inputs(inputs: Any, model: str) -> list[tuple[str, bytes]]:
    """Time and inputs, whose units have to be those of the model: nothing is converted."""
    units = {"time": "s"} | {it["name"]: it.get("unit") for it in describe(model)["variables"]}
    given = []
    for title, values in columns(inputs, "inputs"):
        name, _, unit = title.partition(" [")
        if unit and unit.rstrip("]") != units.get(name):
            raise ValueError(f"the input `{title}` has to be in {units.get(name)}")
        given.append((name, values.tobytes()))
    given.sort(key=lambda column: column[0] != "time")
    if not given or given[0][0] != "time":
        raise ValueError("the inputs have no column `time` in s")
    return given


def _values(parameters: Mapping[str, Value] | None) -> list[str]:
    return [f"{name}={_written(name, value)}" for name, value in (parameters or {}).items()]


def _written(name: str, value: Value) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    if isinstance(value, str):
        return json.dumps(value)
    raise TypeError(f"{name}: {value!r} is neither a number, a switch nor a text")


def _libraries() -> Path | None:
    """The folder of the libraries that the package brings; none where the environment names another."""
    folder = FOLDER / "libraries"
    return folder if folder.is_dir() and "STRUT_LIBRARIES" not in os.environ else None
