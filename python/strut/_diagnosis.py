"""What a model lacks, from measured records."""

from __future__ import annotations

import functools
import html
import io
import json
import os
import sys
import time
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from strut import _strut
from strut._frames import columns, shown
from strut._models import _libraries

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHARES = ["noise", "parameters", "effects", "unmodelled", "unexplained"]


class Diagnosis:
    """What a diagnosis found. In a notebook it shows itself as the report's page."""

    def __init__(self, outcome: _strut.Outcome) -> None:
        self._outcome = outcome

    @functools.cached_property
    def report(self) -> dict[str, Any]:
        """All findings, as in ``report.json``."""
        return json.loads(self._outcome.json())

    @property
    def verdict(self) -> str:
        """``identified``, ``ambiguous``, ``unmodelled``, ``parameter_mismatch``, ``no_effect``, ``bad_data`` or another
        word of the reference."""
        return self.report["verdict"]

    @property
    def summary(self) -> str:
        """The verdict in one or two sentences."""
        return self.report["summary"]

    @property
    def account(self) -> pd.DataFrame:
        """Where each signal's error power goes on the validation data, as shares of the starting model's.

        ``error`` is the starting model's root mean square error in the signal's SI unit. The shares add up to one.
        """
        rows = {signal: [error, *shares] for signal, error, shares in self._outcome.account()}
        frame = pd.DataFrame.from_dict(rows, orient="index", columns=["error", *SHARES])
        return shown(frame.rename_axis("signal"))

    @property
    def effects(self) -> pd.DataFrame:
        """The identified effects, one parameter a row: value and 95 % interval in its SI unit, and how much is explained."""
        rows = [
            {
                "effect": effect["name"],
                "place": effect["element"],
                "parameter": parameter["name"],
                "value": parameter["value"],
                "low": parameter["low"],
                "high": parameter["high"],
                "unit": parameter["unit"],
                "explained": effect["evidence"]["variance_explained"],
            }
            for effect in self.report["effects"]
            for parameter in effect["parameters"]
        ]
        names = ["effect", "place", "parameter", "value", "low", "high", "unit", "explained"]
        return shown(pd.DataFrame(rows, columns=names))

    @property
    def nominal_parameters(self) -> pd.DataFrame:
        """The starting model's parameters before and after the fit, with 95 % intervals, in SI units."""
        frame = pd.DataFrame(self.report["nominal_parameters"])
        names = ["name", "before", "after", "low", "high", "unit", "mismatch"]
        return shown(frame.reindex(columns=names).set_index("name"))

    @property
    def fit(self) -> pd.DataFrame:
        """Fit (1 − rms error / rms signal) of each signal on the validation data: starting, fitted and extended model."""
        names = {"fit_before": "starting", "fit_fitted": "fitted", "fit_after": "extended", "noise_floor": "noise"}
        frame = pd.DataFrame(self.report["signals"]).reindex(columns=["name", "unit", *names])
        return shown(frame.rename(columns=names).set_index("name"))

    @property
    def parameters(self) -> str | None:
        """The extended model's parameter set (TOML), as ``strut fmu --parameters`` takes it; none with unusable data."""
        return self._outcome.parameters()

    @property
    def html(self) -> str:
        """The report's page, which needs no other file."""
        return self._outcome.html()

    def plot(self) -> Figure:
        """Where each signal's error comes from, and the signal that the starting model misses.

        >>> result.plot().savefig("account.png")                # doctest: +SKIP
        """
        from matplotlib.figure import Figure

        missing = self.report["missing"]
        account = self.account
        figure = Figure(figsize=(9, 3 + (2.5 if missing else 0)), layout="constrained")
        axes = figure.subplots(2 if missing else 1, squeeze=False)[:, 0]
        (account[SHARES] * 100).plot.barh(stacked=True, ax=axes[0], width=0.7)
        axes[0].invert_yaxis()
        axes[0].set(xlabel="share of the starting model's error power in %", ylabel="", title=self.summary)
        axes[0].title.set_wrap(True)
        axes[0].legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
        if missing:
            axes[1].plot(missing["time"], missing["value"], linewidth=0.8)
            axes[1].set(xlabel="time in s", ylabel=f"missing at the {missing['place']} in {missing['unit']}")
        return figure

    def save(self, folder: str | os.PathLike[str] = "report", *, fmu: bool = True, record: bool = True) -> Path:
        """Writes ``report.html``, ``report.json`` and the extended model (``extended.toml``, ``.ssv``, ``.fmu``; of another maker's
        FMU ``augmented.ssp``).

        :param fmu: Whether ``extended.fmu`` or ``augmented.ssp`` is made.
        :param record: Whether a part of a validation record goes into it, so that others can replay it. Without one there is no
            ``augmented.ssp``.
        :raises OSError: With all files that could not be written; the others are there.
        """
        for note in self._outcome.save(os.fspath(folder), [fmu, record], _libraries()):
            warnings.warn(note, stacklevel=2)
        return Path(folder)

    def __repr__(self) -> str:
        return self._outcome.text()

    def _repr_html_(self) -> str:
        page = html.escape(self.html, quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 900px; border: 0"></iframe>'


def diagnose(
    train: Any,
    test: Any,
    rig: str | None = None,
    *,
    parameters: str | os.PathLike[str] | None = None,
    map: str | os.PathLike[str] | None = None,
    sampling_rate: float | None = None,
    skip_rows: int | None = None,
    known: Mapping[str, tuple[float, float]] | None = None,
    effects: Sequence[str] = (),
    stroke: float | None = None,
    force: float | None = None,
    rate: float | None = None,
    bandwidth: float | None = None,
    duration: float | None = None,
    time_limit: float = 600.0,
    progress: bool = True,
) -> Diagnosis:
    """Estimates from records what the rig's model lacks: where, how much, and which known effect explains it.

    :param train: Estimation data: a path (CSV, Excel, MDF 4, MATLAB, HDF5, Parquet), a frame of pandas or polars, or a list
        of them. Columns are called as the rig's signals, with units in brackets: ``"suspension.deflection [mm]"``. Without a
        unit, SI.
    :param test: Validation data, of another excitation.
    :param rig: A name of :func:`rigs`.
    :param parameters: Parameter set (TOML) of the starting model in place of the rig's.
    :param map: File (TOML) with other names, units, signs and delays of the columns.
    :param sampling_rate: Samples per second of records without a column of time.
    :param skip_rows: Lines above the row that names the columns, where that row is not found.
    :param known: Independently measured parameters: value and standard deviation in SI units,
        e.g. ``{"sprung_mass": (94.4, 0.5)}``.
    :param effects: Only these effects, by their numbers in the catalogue, e.g. ``["01", "04"]``.
    :param stroke: Largest stroke of a deciding experiment in m (rad of a pivot).
    :param force: Largest force of it in N (N.m of a torque).
    :param rate: Largest rate of road or motion in it in m/s.
    :param bandwidth: Highest frequency of it in Hz.
    :param duration: Its duration in s.
    :param time_limit: Time in s after which the best answer so far is returned.
    :param progress: Whether the stages are shown on a terminal or in a notebook.
    :raises ValueError: If a record cannot be read or lacks signals that the rig needs: what to do.

    >>> hidden = {"strut.coulomb.force": 60}
    >>> train, test = strut.virtual_records("tum-linear-measured-quarter-car", hidden, length=10.0)
    >>> result = strut.diagnose(train, test, "tum-linear-measured-quarter-car", progress=False)
    >>> result.verdict
    'identified'
    >>> list(result.effects["effect"])[0]
    'Coulomb friction'
    """
    shown = _Progress(progress)
    try:
        outcome = _strut.diagnose(
            _records(train, "train"),
            _records(test, "test"),
            rig=rig,
            parameters=None if parameters is None else os.fspath(parameters),
            map=None if map is None else Path(map).read_text(encoding="utf-8"),
            sampling_rate=sampling_rate,
            skip_rows=skip_rows,
            known=[f"{name}={value!r}±{deviation!r}" for name, (value, deviation) in (known or {}).items()],
            effects=list(effects),
            limits=[stroke, force, rate, bandwidth, duration],
            time_limit=float(time_limit),
            command=f"strut.diagnose(…, rig={rig!r})",
            progress=shown.stage,
        )
    finally:
        shown.end()
    return Diagnosis(outcome)


def rigs() -> list[str]:
    """The rigs that can be diagnosed.

    >>> "tum-quarter-vehicle" in strut.rigs()
    True
    """
    return _strut.rigs()


def rig(name: str) -> str:
    """What a rig's records may hold, with units, and what is looked for in them; to be printed.

    >>> print(strut.rig("tum-quarter-vehicle"))                  # doctest: +ELLIPSIS
    tum-quarter-vehicle...
    """
    return _strut.rig(name)


def virtual_records(
    rig: str,
    hide: Mapping[str, float] | None = None,
    *,
    noise: float = 0.01,
    seed: int = 1,
    step_size: float = 1e-3,
    length: float = 20.0,
    amplitude: float = 1.0,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Records of a virtual rig, for estimation and for validation, to try a diagnosis with.

    :param hide: Parameters that differ from the rig's, in SI units, e.g. ``{"strut.coulomb.force": 60}`` (N), and
        distortions of sensors, e.g. ``{"body.acceleration.gain": 0.05}``.
    :param noise: Standard deviation of the noise over the root mean square of each signal.
    :param seed: For phases and noise.
    :param step_size: Distance of the samples in s.
    :param length: Length of each record in s.
    :param amplitude: Size of the excitation, relative to the rig's usual one.

    >>> train, test = strut.virtual_records("tum-quarter-vehicle", length=5.0)
    >>> len(train)
    5000
    """
    hidden = [f"{name}={float(value)!r}" for name, value in (hide or {}).items()]
    texts = _strut.virtual_records(rig, hidden, noise, seed, step_size, length, amplitude)
    train, test = (pd.read_csv(io.StringIO(text)) for text in texts)
    return train, test


def _records(given: Any, name: str) -> list[Any]:
    several = given if isinstance(given, (list, tuple)) else [given]
    return [
        os.fspath(it) if isinstance(it, (str, os.PathLike)) else (title, _bytes(it, title))
        for it, title in zip(several, [name] if len(several) == 1 else [f"{name} {i}" for i in range(1, len(several) + 1)])
    ]


def _bytes(frame: Any, name: str) -> list[tuple[str, bytes]]:
    return [(title, values.tobytes()) for title, values in columns(frame, name)]


class _Progress:
    """The stage on one line of stderr, which terminals and notebooks write over."""

    def __init__(self, wanted: bool) -> None:
        self._shown = wanted and (sys.stderr.isatty() or "ipykernel" in sys.modules)
        self._start = time.monotonic()
        self._width = 0

    def stage(self, text: str) -> None:
        if self._shown:
            line = f"{time.monotonic() - self._start:4.0f} s  {text}"
            print(f"\r{line:<{self._width}}", end="", file=sys.stderr, flush=True)
            self._width = len(line)

    def end(self) -> None:
        if self._shown and self._width:
            print(f"\r{'':<{self._width}}\r", end="", file=sys.stderr, flush=True)
