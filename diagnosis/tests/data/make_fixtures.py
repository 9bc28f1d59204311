"""Makes the small MDF4 and MATLAB files beside it.

    pip install asammdf scipy
    python make_fixtures.py

asammdf and scipy are independent writers: what the readers of the diagnosis understand of these files,
they understand of other people's.
"""

from pathlib import Path

import numpy as np
from asammdf import MDF, Signal
from scipy.io import savemat

HERE = Path(__file__).parent
N = 50
TIME = np.arange(N) * 0.01
FORCE = 100.0 * np.sin(2.0 * np.pi * TIME)
COUNTS = (np.arange(N) * 37 % 200 - 100).astype(np.int16)
LINEAR = {"a": 0.5, "b": 3.0}
RATIONAL = {"P1": 0.0, "P2": 1.0, "P3": -4.0, "P4": 0.0, "P5": 0.0, "P6": 4.0}


def signals():
    """Doubles, singles, integers with a linear conversion, big-endian values, and an invalid sample."""
    invalid = np.zeros(N, dtype=bool)
    invalid[7] = True
    return [
        Signal(FORCE, TIME, name="force", unit="N"),
        Signal(FORCE.astype(np.float32), TIME, name="single", unit="kN"),
        Signal(COUNTS, TIME, name="counts", unit="mm", conversion=LINEAR),
        Signal(COUNTS.astype(">i4"), TIME, name="big", unit="V"),
        Signal(np.abs(COUNTS).astype(np.uint8), TIME, name="byte"),
        Signal(FORCE, TIME, name="gaps", unit="N", invalidation_bits=invalid),
        Signal(COUNTS, TIME, name="ratio", unit="A", conversion=RATIONAL),
    ]


def mdf(name, groups, compression=0):
    with MDF(version="4.10") as file:
        for group in groups:
            file.append(group, common_timebase=True)
        file.save(HERE / name, overwrite=True, compression=compression)


slow = np.arange(6) * 0.1
mdf("plain.mf4", [signals()])
mdf("deflate.mf4", [signals()], compression=1)
mdf("transposed.mf4", [signals()], compression=2)
mdf("two-rates.mf4", [[Signal(FORCE, TIME, name="force", unit="N")],
                      [Signal(10.0 * slow, slow, name="ramp", unit="m"),
                       Signal(-10.0 * slow, slow, name="force", unit="N")]])
mdf("table-conversion.mf4", [[Signal(COUNTS.astype(np.uint8) % 3, TIME, name="gear",
                              conversion={"val_0": 0, "text_0": b"off", "val_1": 1, "text_1": b"on",
                                          "default": b"?"})]])

columns = {"t": TIME, "force": FORCE.reshape(-1, 1), "counts": COUNTS, "single": FORCE.astype(np.float32),
           "rig": "number 3", "gain": 2.5}
savemat(HERE / "vectors.mat", columns, oned_as="column")
savemat(HERE / "compressed.mat", columns, do_compression=True, oned_as="row")
savemat(HERE / "struct.mat", {"run": {"time": TIME, "force": FORCE, "counts": COUNTS}}, do_compression=True)
(HERE / "hdf5.mat").write_bytes(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM"
                                + bytes(384) + b"\x89HDF\r\n\x1a\n")
