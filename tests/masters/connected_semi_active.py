"""The semi-active rig with its drive, controller and brake shows what its source found.

    python connected_semi_active.py FOLDER
"""

import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent.parent / "examples"))
from ssp import open_system  # noqa: E402

SIGNALS = ["drive.angle", "drive.speed", "rig.body_arm.angle", "rig.tire.force"]


def run(folder, name, stop, step=1e-3):
    with open_system(folder, name) as connected:
        return connected.run(stop, step, SIGNALS, every=round(1e-2 / step))


def swing(result, begin, end):
    """Half the range of the body arm's angle."""
    inside = (result["time"] >= begin - 1e-9) & (result["time"] <= end + 1e-9)
    return 0.5 * float(np.ptp(result["rig.body_arm.angle"][inside]))


def ramp(folder):
    """3.2.2: the frequency follows 0.1 t Hz, load and all, and the body's resonance is passed on the way."""
    result = run(folder, "sas", 20.0)
    time, turns = result["time"], result["drive.angle"] / math.tau
    lag = np.abs(turns - 0.05 * time**2).max()
    assert lag < 0.02, f"{lag} turns off the ramp"
    late = time > 3.0
    spread = np.abs(result["drive.speed"][late] / math.tau / (0.1 * time[late]) - 1.0).max()
    assert 0.02 < spread < 0.12, f"the frequency is off by up to {spread} of itself"
    swings = [swing(result, begin, begin + 2.0) for begin in range(0, 20, 2)]
    # 1.46 Hz are passed at 14.6 s; the swing is largest behind it.
    assert np.argmax(swings) == 8 and swings[8] > 5.0 * swings[4], swings
    print(f"sas: {lag:.4f} turns off the ramp, body swings by up to {swings[8]:.3f} rad")


def currents(folder):
    """Figs. 15-17: at 1.6 Hz more current leaves less of the swing."""
    found = {}
    # In the steady state, on an eccentric that turns steadily: 0.0597, 0.0469, 0.0419 (tests of SasRig).
    for percent, steady in (30, 0.0597), (70, 0.0469), (100, 0.0419):
        name = f"sas-{percent}-percent"
        found[percent] = swing(run(folder, name, 20.0), 15.0, 20.0)
        finer = swing(run(folder, name, 20.0, 0.5e-3), 15.0, 20.0)
        # The error of the exchange is proportional to the step: 0.4 % of half a millisecond.
        assert abs(found[percent] / finer - 1.0) < 0.01, f"{name}: {found[percent]} and {finer} at half the step"
        # What is left of the frequency's swing within a turn adds to it.
        assert abs(found[percent] / steady - 1.0) < 0.02, f"{name}: {found[percent]}, steadily turned {steady}"
        print(f"{name}: body swings by {found[percent]:.4f} rad")
    assert found[30] > found[70] > found[100]


if __name__ == "__main__":
    for check in (ramp, currents):
        check(Path(sys.argv[1]))
