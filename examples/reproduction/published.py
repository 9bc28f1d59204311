"""The printed numbers of published.toml: what the FMUs take over, and what cannot be compared."""

import tomllib
from functools import cache
from pathlib import Path

from measure import parameters
from sheet import Missing, Taken


@cache
def entries():
    return tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))


def taken(fmus, source):
    """The values of a source that its FMUs start with."""
    read = cache(lambda fmu: parameters(fmus, fmu))
    for block in entries()[source].get("taken", []):
        for what, printed, unit, variable, *factor in block["values"]:
            name = variable.removeprefix("1 / ")
            value = read(block["fmu"])[name]
            found = (value if name == variable else 1.0 / value) * (factor[0] if factor else 1.0)
            yield Taken(what, block["place"], printed, found, unit, f"{block['fmu']}: {variable}")


def missing(source):
    """The values of a source that nothing here can be compared with."""
    for block in entries()[source].get("missing", []):
        for what, printed, reason in block["values"]:
            yield Missing(what, block["place"], printed, reason)
