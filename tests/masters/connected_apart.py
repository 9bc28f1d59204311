"""Rig and actuator as two FMUs, in masters that hold what they exchange: the same as both in one.

    python connected_apart.py FOLDER

`konieczny-apart` in steps of 1 ms in masters that others have written. That it takes an actuator which knows its load is
shown with our own.
"""

import sys
from pathlib import Path

import numpy as np
from connected import MASTERS

sys.path.insert(0, str(Path(__file__).parent.parent.parent / "examples"))
from ssp import open_system  # noqa: E402

NAME, STEP, COUNT = "konieczny-apart", 1e-3, 1000
# Signals of the pair and of the one, and how far apart they may be, by their range.
PAIRS = {
    "rig.body.position": ("one.body.position", 0.01),
    "rig.wheel.position": ("one.wheel.position", 0.015),
    # It is that of the millisecond to come.
    "actuator.force": ("one.actuator.force", 0.03),
}
SIGNALS = [*PAIRS, *(one for one, _ in PAIRS.values())]


def apart(result):
    """Differences in shares of the ranges. There is no row for the start in every master."""
    return {
        name: float(np.abs(result[name][1:] - result[one][1:]).max() / np.ptp(result[one][1:]))
        for name, (one, _) in PAIRS.items()
    }


def main():
    folder = Path(sys.argv[1])
    for name, (master, _) in MASTERS.items():
        found = apart(master(folder / f"{NAME}.ssp", STEP, COUNT, SIGNALS))
        print(f"{name}: " + ", ".join(f"{signal} {100.0 * share:.2f} %" for signal, share in found.items()))
        for signal, (_, bound) in PAIRS.items():
            assert found[signal] < bound, (name, signal, found[signal])
    with open_system(folder, NAME, {"actuator.load.mass": 0.0}) as system:
        without = apart(system.run(COUNT * STEP, STEP, SIGNALS))
    assert without["actuator.force"] > 100.0, without


if __name__ == "__main__":
    main()
