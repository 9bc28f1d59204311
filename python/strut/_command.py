"""The commands `strut`, `build-fmu` and `diagnose`: the program that the package brings."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
PROGRAM = FOLDER / "bin" / ("strut.exe" if os.name == "nt" else "strut")


def strut() -> None:
    """`strut …`"""
    _run()


def build_fmu() -> None:
    """`build-fmu …`, which is `strut fmu …`."""
    _run("fmu")


def diagnose() -> None:
    """`diagnose …`, which is `strut diagnose …`."""
    _run("diagnose")


def _run(*first: str) -> None:
    arguments = [str(PROGRAM), *first, *sys.argv[1:]]
    # In place of this process, signals and exit codes are the program's own.
    if os.name == "posix":
        os.execv(PROGRAM, arguments)
    try:
        sys.exit(subprocess.call(arguments))
    except KeyboardInterrupt:
        sys.exit(130)
