"""What a section of the page consists of: numbers, claims and figures, each with its source."""

from collections.abc import Callable
from dataclasses import dataclass, field


@dataclass
class Number:
    """A printed number and the one found here, in the same unit.

    One that does not come out needs a reason; one that does must not have any.
    """

    what: str
    source: str
    printed: float
    found: float
    # Half a unit of the last printed digit, more where the source cuts digits off.
    within: float
    unit: str = ""
    reason: str = ""

    @property
    def comes_out(self):
        return abs(self.found - self.printed) <= self.within

    def row(self):
        unit = f" {self.unit}" if self.unit else ""
        # One digit more than can be compared.
        digits = max(0, min(12, 1 - leading(self.within)))
        found = f"{self.found:.{digits}f}" if abs(self.found) < 1e8 else f"{self.found:.6g}"
        mark = "✓" if self.comes_out else f"✗ {self.reason}"
        return f"| {self.what} | {self.source} | {plain(self.printed)}{unit} | {found}{unit} | {mark} |"

    def failure(self):
        if self.comes_out and self.reason:
            return f"{self.what}: comes out, but a reason is given why it should not"
        if not self.comes_out and not self.reason:
            return f"{self.what}: printed {self.printed}, found {self.found}"
        return None


@dataclass
class Taken:
    """A printed number that an FMU starts with; nothing is calculated."""

    what: str
    source: str
    printed: float
    found: float
    unit: str
    where: str

    def row(self):
        unit = f" {self.unit}" if self.unit else ""
        return f"| {self.what} | {self.source} | {plain(self.printed)}{unit} | {plain(self.found)}{unit} | {self.where} |"

    def failure(self):
        # Beyond the digits of any source; less is lost by converting units.
        if abs(self.found - self.printed) <= 1e-7 * abs(self.printed):
            return None
        return f"{self.source}, {self.what}: printed {self.printed}, {self.where} is {self.found}"


@dataclass
class Missing:
    """Printed numbers that nothing here can be compared with."""

    what: str
    source: str
    printed: str
    reason: str

    def row(self):
        return f"| {self.what} | {self.source} | {self.printed} | {self.reason} |"


@dataclass
class Claim:
    """What a source says or a figure of it shows, measured."""

    what: str
    source: str
    measured: str
    holds: bool

    def row(self):
        return f"| {self.what} | {self.source} | {self.measured} | {'✓' if self.holds else '✗'} |"

    def failure(self):
        return None if self.holds else f"{self.what}: {self.measured}"


@dataclass
class Figure:
    """A picture beside the source's."""

    file: str
    caption: str
    draw: Callable


@dataclass
class Section:
    """One source."""

    title: str
    numbers: list = field(default_factory=list)
    claims: list = field(default_factory=list)
    figures: list = field(default_factory=list)
    taken: list = field(default_factory=list)
    missing: list = field(default_factory=list)

    def lines(self):
        yield from (f"## {self.title}", "")
        if self.numbers:
            yield from ("| number | source | printed | here | |", "|---|---|---|---|---|")
            yield from (number.row() for number in self.numbers)
            yield ""
        if self.claims:
            yield from ("| claim | source | measured | |", "|---|---|---|---|")
            yield from (claim.row() for claim in self.claims)
            yield ""
        for figure in self.figures:
            yield from (f"![{figure.caption}](pictures/{figure.file})", "", f"*{figure.caption}*", "")
        if self.taken:
            yield from folded("Printed numbers that the FMUs start with", TAKEN, self.taken)
        if self.missing:
            yield from folded("Printed numbers that cannot be compared, and why", MISSING, self.missing)

    def failures(self):
        return [failure for entry in [*self.numbers, *self.taken, *self.claims] if (failure := entry.failure())]


TAKEN = ("| number | source | printed | here | FMU and variable |", "|---|---|---|---|---|")
MISSING = ("| number | source | printed | why not |", "|---|---|---|---|")


def folded(summary, head, entries):
    """A table that a reader unfolds."""
    yield from ("<details>", f"<summary>{summary}</summary>", "", *head)
    yield from (entry.row() for entry in entries)
    yield from ("", "</details>", "")


def leading(value):
    """The power of ten of a number's first digit."""
    return int(f"{value:e}".rpartition("e")[2])


def plain(value):
    """A number as a source prints it."""
    return f"{value:.10g}" if 1e-3 <= abs(value) < 1e8 or value == 0.0 else f"{value:.7g}"
