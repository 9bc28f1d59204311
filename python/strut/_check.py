"""Whether an FMU or SSP is fit for other tools."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field

from strut import _strut
from strut._command import PROGRAM


@dataclass(frozen=True)
class Finding:
    """Something that is wrong, or narrows where an FMU works."""

    level: str
    """``error``, ``warning`` or ``note``."""
    rule: str
    """The rule's name."""
    section: str
    """The standard and its section; empty for what no standard demands."""
    message: str
    """What is wrong."""
    place: str | None = None
    """Where."""
    help: list[str] = field(default_factory=list)
    """What to do."""


@dataclass(frozen=True)
class Report:
    """What a check found."""

    findings: list[Finding]
    about: list[str]
    """What was checked."""
    done: list[str]
    """The checks that were made."""
    skipped: list[str]
    """The checks that were not, with the reason."""

    @property
    def problems(self) -> int:
        """Number of errors and warnings."""
        return sum(it.level in ("error", "warning") for it in self.findings)

    def __str__(self) -> str:
        lines = ["; ".join(self.about)]
        for it in self.findings:
            place = f" ({it.place})" if it.place else ""
            lines.append(f"{it.level}[{it.rule}]: {it.message}{place}")
            lines += [f"  help: {text}" for text in it.help]
        lines.append(f"{self.problems} problems" if self.problems else "no problems")
        return "\n".join(lines)


def check(
    path: str | os.PathLike[str], *, run: bool = True, replay: bool = False, timeout: float = 30.0
) -> Report:
    """Checks an FMU or SSP, anyone's: its description, its libraries, and how they behave.

    Libraries run in processes of their own: one that crashes is a finding.

    :param run: Whether code of the FMU is run.
    :param replay: Whether the experiments in the FMU are run and compared with the errors that they state.
    :param timeout: Time that each run may take in s.
    :raises ValueError: If the file cannot be read.

    >>> strut.check(strut.fmu("LinearMotor", folder="fmus")).problems
    0
    """
    report = json.loads(_strut.check(os.fspath(path), [str(PROGRAM), "probe"], [run, replay], timeout))
    report["findings"] = [Finding(**it) for it in report["findings"]]
    return Report(**report)
