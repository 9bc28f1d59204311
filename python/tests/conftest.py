"""The installed package: without cargo, and not in the project's folder."""

import doctest
import os
from pathlib import Path

import pandas as pd
import pytest

import strut

RIG = "tum-linear-measured-quarter-car"


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """An empty folder to work in, and a path without cargo and rustc."""
    monkeypatch.chdir(tmp_path)
    bare = [it for it in os.environ["PATH"].split(os.pathsep) if not (Path(it) / "cargo").exists()]
    monkeypatch.setenv("PATH", os.pathsep.join(bare))
    for name in ("CARGO", "RUSTC", "STRUT_LIBRARIES", "CARGO_MANIFEST_DIR"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture(scope="session", autouse=True)
def diagnosed_once():
    """Pages, docstrings and tests diagnose the same records: that is done once."""
    made, diagnose = {}, strut.diagnose

    def key(it):
        return it.to_csv() if isinstance(it, pd.DataFrame) else repr(it)

    def shared(train, test, *arguments, **options):
        if not all(isinstance(it, pd.DataFrame) for it in (train, test)):
            return diagnose(train, test, *arguments, **options)
        asked = {name: it for name, it in options.items() if name != "progress"}
        what = tuple(map(key, (train, test, arguments, sorted(asked.items()))))
        if what not in made:
            made[what] = diagnose(train, test, *arguments, **options)
        return made[what]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(strut, "diagnose", shared)
        yield


@pytest.fixture(scope="session")
def records(diagnosed_once):
    """Records of a virtual rig with a friction of 60 N hidden in its strut."""
    return strut.virtual_records(RIG, {"strut.coulomb.force": 60.0}, length=10.0)


@pytest.fixture(scope="session")
def result(records):
    return strut.diagnose(*records, RIG, progress=False)


@pytest.fixture
def examples():
    """Runs the examples in a module's docstrings; how many there are."""

    def run(module):
        tested = doctest.testmod(module, extraglobs={"strut": strut}, optionflags=doctest.ELLIPSIS)
        assert tested.failed == 0
        return tested.attempted

    return run
