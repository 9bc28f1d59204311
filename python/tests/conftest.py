"""The installed package: without cargo, and not in the project's folder."""

import doctest
import os
from pathlib import Path

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


@pytest.fixture(scope="session")
def records():
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
