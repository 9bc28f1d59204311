"""The systems that have no reference as a whole, in a master that others have written, against our own.

    python connected_all.py fmpy|libcosimpy|ecos FOLDER

All are Jacobi masters with a fixed step, which must agree to rounding. What each component does alone has references of
its own, and what the systems are to show is tested elsewhere.
"""

import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from connected import AGREEMENT, MASTERS
from connected_systems import REFERENCED
from matrix_jobs import ZeroAtFirst

sys.path.insert(0, str(Path(__file__).parent.parent.parent / "examples"))
from ssp import NAMESPACES, open_system  # noqa: E402

# A second: the roads that begin at 0.5 s have reached the rear wheels.
STEP, COUNT = 1e-3, 1000


# tum-rig's exciter has kinks (dead zone, friction, limits). Masters add up their clocks in different ways, and one
# rounding apart the error control goes in other steps: what then differs is within its tolerance, which is 1e-7
# (with 1e-10 it is 1e-10).
APART = {"tum-rig": 1e-5}


# In the first step, which FMPy takes with zero inputs, the wheel of `sas` hangs in the air: nothing like the reference.
COMPARED = {"fmpy": [name for name in REFERENCED if name != "sas"], "libcosimpy": REFERENCED, "ecos": REFERENCED}


SCHEMES = {name: scheme for name, (_, scheme) in MASTERS.items()} | {"fmpy": ZeroAtFirst}


def outputs(path):
    """What the system declares as outputs of its components."""
    with zipfile.ZipFile(path) as archive:
        root = ElementTree.fromstring(archive.read("SystemStructure.ssd"))
    for component in root.iterfind(".//ssd:Component", NAMESPACES):
        for connector in component.iterfind(".//ssd:Connector[@kind='output']", NAMESPACES):
            yield f"{component.get('name')}.{connector.get('name')}"


def main():
    name, folder = sys.argv[1], Path(sys.argv[2])
    (master, _), scheme = MASTERS[name], SCHEMES[name]
    failures, seen = [], 0
    for path in sorted(folder.glob("*.ssp")):
        if path.stem in COMPARED[name]:
            continue
        signals = list(outputs(path))
        found = master(path, STEP, COUNT, signals)
        with open_system(folder, path.stem, kind=scheme) as system:
            own = system.run(COUNT * STEP, STEP, signals)
        worst = 0.0
        for signal in signals:
            # There is no row for the start in every master.
            apart = np.abs(found[signal][1:] - own[signal][1:]).max()
            scale = np.abs(own[signal]).max()
            worst = max(worst, apart / scale if scale > 0.0 else apart)
            if not apart <= APART.get(path.stem, AGREEMENT) * scale:
                failures.append((path.stem, signal, apart, scale))
        print(f"{name}: {path.stem:<24}{len(signals):>4} signals, {worst:.1e}")
        seen += 1
    assert seen >= 8, f"only {seen} systems in {folder}"
    assert not failures, failures


if __name__ == "__main__":
    main()
