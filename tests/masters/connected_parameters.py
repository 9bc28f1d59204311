"""The parameter sets in a system's file take effect in the masters that read them.

    python connected_parameters.py FOLDER

As delivered they restate what the FMUs have built in, so a set that is not read goes unnoticed. Here a copy of
the system switches its controller on at another time.
"""

import sys
import tempfile
import zipfile
from pathlib import Path

import numpy as np
from connected import ecos, libcosimpy

SYSTEM, STEP, SIGNAL = "quanser-lqr", 1e-3, "controller.force"
BUILT_IN, CHANGED = b'value="5.0"', b'value="0.1"'


def change(source, target):
    changed = 0
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            if name.endswith(".ssv"):
                changed += content.count(BUILT_IN)
                content = content.replace(BUILT_IN, CHANGED)
            new.writestr(name, content)
    assert changed == 1, f"{changed} values found"


def main():
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{SYSTEM}.ssp"
        change(Path(sys.argv[1]) / f"{SYSTEM}.ssp", path)
        for master in (libcosimpy, ecos):
            result = master(path, STEP, 150, [SIGNAL])
            working = np.nan_to_num(result[SIGNAL]) != 0.0
            # The tick at 0.1 s shows at the end of the step that begins there.
            first = result["time"][working][0]
            assert abs(first - 0.101) < 1e-9, (master.__name__, first)
            print(f"{master.__name__}: the controller works from {first - STEP:.3f} s on")


if __name__ == "__main__":
    main()
