from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import final

__version__: str

_Columns = list[tuple[str, bytes]]
_Record = str | PathLike[str] | tuple[str, _Columns]

def models(libraries: Path | None) -> str: ...
def describe(name: str, libraries: Path | None) -> str: ...
def fmu(
    model: str, values: list[str], name: str | None, folder: str | PathLike[str], libraries: Path | None
) -> Path: ...
def simulate(
    model: str,
    values: list[str],
    inputs: _Columns | None,
    step: float | None,
    stop: float | None,
    libraries: Path | None,
) -> tuple[bytes, list[tuple[str, str, bytes]]]: ...
def check(path: str | PathLike[str], program: list[str], runs: list[bool], timeout: float) -> str: ...
def rigs() -> list[str]: ...
def rig(name: str) -> str: ...
def is_time(name: str) -> bool: ...
def virtual_records(
    rig: str, hide: list[str], noise: float, seed: int, step: float, length: float, amplitude: float
) -> list[str]: ...
def diagnose(
    train: list[_Record],
    test: list[_Record],
    *,
    rig: str | None,
    parameters: str | PathLike[str] | None,
    map: str | None,
    sampling_rate: float | None,
    skip_rows: int | None,
    known: list[str],
    effects: list[str],
    limits: list[float | None],
    time_limit: float,
    command: str,
    progress: Callable[[str], None],
) -> Outcome: ...

@final
class Outcome:
    def json(self) -> str: ...
    def html(self) -> str: ...
    def text(self) -> str: ...
    def account(self) -> list[tuple[str, float, list[float]]]: ...
    def parameters(self) -> str | None: ...
    def save(self, folder: str | PathLike[str], parts: list[bool], libraries: Path | None) -> list[str]: ...
