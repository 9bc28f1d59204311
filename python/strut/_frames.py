"""Frames of pandas and polars, and mappings of columns, as titles and arrays of doubles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from strut import _strut


class _Shown(pd.DataFrame):
    """A frame that prints all of its columns, whatever the terminal's width, with four digits."""

    @property
    def _constructor(self) -> type[pd.DataFrame]:
        return pd.DataFrame

    def __repr__(self) -> str:
        return self.to_string(float_format=lambda value: f"{value:.4g}")


def shown(frame: pd.DataFrame) -> pd.DataFrame:
    """The same frame, printed whole."""
    return _Shown(frame)


def columns(frame: Any, name: str) -> list[tuple[str, np.ndarray]]:
    """Title, with the unit in brackets if ``attrs["units"]`` has one, and values of each column.

    A pandas index is the time if no column is: one of dates, durations or floats, or with the name of a time.

    :raises ValueError: If a column is not of numbers, or nothing is the time: row numbers are none.
    """
    if isinstance(frame, Mapping):
        found = [(str(title), values) for title, values in frame.items()]
    elif hasattr(frame, "columns") and hasattr(frame, "__getitem__"):
        found = [(str(title), frame[title]) for title in frame.columns]
    else:
        raise TypeError(f"{name}: neither a path nor a frame of pandas or polars, but a {type(frame).__name__}")
    units = getattr(frame, "attrs", {}).get("units", {})
    timed = any(_strut.is_time(title.partition(" [")[0]) for title, _ in found)
    if not timed and isinstance(frame, pd.DataFrame):
        index = frame.index
        named = index.name is not None and _strut.is_time(str(index.name).partition(" [")[0])
        if named or index.dtype.kind in "mMf":
            found.insert(0, ("time [s]" if index.dtype.kind in "mM" or not named else str(index.name), index))
        elif not isinstance(index, pd.RangeIndex):
            raise ValueError(
                f"{name}: no column is the time, and the index only counts rows. Name the time's column `time [s]`, or make it "
                "the index and give that this name"
            )
    return [
        (title if "[" in title or title not in units else f"{title} [{units[title]}]", _doubles(title, values, name))
        for title, values in found
    ]


def _doubles(title: str, values: Any, name: str) -> np.ndarray:
    if getattr(getattr(values, "dtype", None), "tz", None) is not None:
        # The instants, whatever the clock on the wall shows.
        values = pd.DatetimeIndex(values).tz_convert("UTC").tz_localize(None)
    array = np.asarray(values)
    if np.issubdtype(array.dtype, np.datetime64) or np.issubdtype(array.dtype, np.timedelta64):
        return np.asarray((array - array[0]) / np.timedelta64(1, "ns"), dtype=np.float64) * 1e-9
    try:
        return np.ascontiguousarray(array, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: the column `{title}` is not of numbers: {error}") from None
