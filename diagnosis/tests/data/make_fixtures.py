"""Makes the small files of records beside it: MDF4, MATLAB, HDF5, Parquet and spreadsheets.

    pip install asammdf scipy h5py hdf5storage pandas pyarrow polars openpyxl odfpy
    python make_fixtures.py

These packages are independent writers: what the readers of the diagnosis understand of these files,
they understand of other people's.
"""

from datetime import datetime, timedelta
from pathlib import Path

import h5py
import hdf5storage
import numpy as np
import pandas as pd
import polars as pl
from asammdf import MDF, Signal
from openpyxl import Workbook
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
savemat(HERE / "version4.mat", columns, format="4", oned_as="row")
savemat(HERE / "struct.mat", {"run": {"time": TIME, "force": FORCE, "counts": COUNTS}}, do_compression=True)
# Version 7.3: with MATLAB's own attributes, a struct and a text among the vectors.
hdf5storage.savemat(str(HERE / "hdf5.mat"), {"run": {"t": TIME, "force": FORCE, "counts": COUNTS}, "rig": "number 3"},
                    format="7.3", oned_as="column", truncate_existing=True)

with h5py.File(HERE / "groups.h5", "w") as file:
    group = file.create_group("run 1")
    group.create_dataset("time", data=TIME, compression="gzip")
    group.create_dataset("force", data=FORCE.astype(">f4"), chunks=(7,)).attrs["unit"] = "kN"
    group.create_dataset("counts [mm]", data=COUNTS, shuffle=True, compression="gzip")
    group.create_dataset("matrix", data=np.zeros((N, 3)))
    file["remark"] = "none"

STARTED = datetime(2025, 11, 14, 19, 45, 0)
frame = {"time [s]": TIME, "force [N]": FORCE, "counts": COUNTS, "remark": ["start"] + [None] * (N - 1)}
pd.DataFrame(frame).to_parquet(HERE / "pandas.parquet")
gaps = pl.Series([None if i == 7 else value for i, value in enumerate(FORCE)], dtype=pl.Float32)
stamps = [STARTED + timedelta(seconds=float(t)) for t in TIME]
pl.DataFrame({"timestamp": stamps, "force [N]": gaps}).write_parquet(HERE / "polars.parquet")

book = Workbook()
book.active.title = "Info"
book.active.append(["Test", "Run 3"])
sheet = book.create_sheet("Data")
sheet.append(["Shock dyno", None, None])
sheet.append([])
sheet.append(["Time", "Force", "Counts", "Remark"])
sheet.append(["sec", "lbf", "mm", None])
for i in range(N):
    sheet.append([TIME[i], FORCE[i], int(COUNTS[i]), "start" if i == 0 else None])
dates = book.create_sheet("Dates")
dates.append(["Timestamp", "Force [N]"])
for stamp, force in zip(stamps, FORCE):
    dates.append([stamp, force])
book.save(HERE / "book.xlsx")
pd.DataFrame({"time [s]": TIME, "force [N]": FORCE}).to_excel(HERE / "sheet.ods", index=False)
