"""Batches on a local Dask cluster: nothing is lost, whoever dies.

    python beyond_one_machine.py sweep FOLDER_OF_FMUS SWEEP_PROGRAM OUT
    python beyond_one_machine.py diagnoses DIAGNOSE_PROGRAM RECORDS OUT RIG
"""

import csv
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "examples" / "beyond-one-machine"))

import batch
import diagnoses
import numpy as np
import pyarrow as pa
import sweep

SETS, PART, BAD = 60, 5, 23


def clean(out):
    shutil.rmtree(out, ignore_errors=True)
    return out


def kill_a_worker(connected):
    pids = connected.run(os.getpid)
    assert len(pids) == 2, pids
    os.kill(next(iter(pids.values())), signal.SIGKILL)


def deadly(task):
    """A piece of work that takes its worker with it."""
    if task == 3:
        os._exit(1)
    return {"square": float(task * task)}


def swept(fmus, program, out):
    """A sweep with a bad set, of which a worker is killed and which is interrupted, has every row once, and each is what the
    equations in one process give."""
    sets = sweep.latin_hypercube(SETS, 1)
    sets[BAD, 0] = -1.0
    finished = []
    with batch.client(workers=2) as connected:

        def done(number):
            finished.append(number)
            if len(finished) == 1:
                kill_a_worker(connected)

        work, failed = sweep.sweep(connected, fmus / "QuarterCar.fmu", sets, clean(out / "sweep"), PART, done)
        assert sorted(finished) == list(range(SETS // PART)), finished
        assert failed == 1, failed
        rows = work.table().to_pylist()
        assert [row["index"] for row in rows] == list(range(SETS))
        bad = rows[BAD]
        assert "sprung_mass" in bad["error"] and "-1" in bad["error"], bad
        # As after an interruption: only what is missing is done again, and comes out as before.
        work.path(4).unlink()
        again = []
        resumed, failed = sweep.sweep(connected, fmus / "QuarterCar.fmu", sets, out / "sweep", PART, again.append)
        assert again == [4] and failed == 1, (again, failed)
        assert resumed.table().to_pylist() == rows
        # Results of other sets are not mixed with these.
        try:
            sweep.sweep(connected, fmus / "QuarterCar.fmu", sets + 1.0, out / "sweep", PART)
            raise AssertionError("another plan is accepted")
        except SystemExit as refused:
            assert "another batch" in str(refused), refused
    good = [row for row in rows if row["error"] is None]
    sweep.write_sets(out / "sets.csv", sets[[row["index"] for row in good]])
    subprocess.run([program, out / "sets.csv", "--out", out / "peaks.csv"], check=True)
    with open(out / "peaks.csv", newline="") as file:
        peaks = np.array([[float(number) for number in line] for line in list(csv.reader(file))[1:]])
    ours = np.array([[row[name] for name in sweep.PEAKS] for row in good])
    difference = np.abs(peaks / ours - 1.0).max()
    assert difference < 1e-6, difference
    print(f"sweep: {len(rows)} rows; FMPy and the SIMD lanes differ by {difference:.1e}")


def survived(out):
    """Even what kills every worker that touches it is a row, and its neighbours come out."""
    with batch.client(workers=2) as connected:
        work = batch.Batch(clean(out / "deadly"), {"what": "squares"}, 8, 4)
        failed = work.run(connected, deadly, lambda index: index, [("square", pa.float64())])
    rows = work.table().to_pylist()
    assert failed == 1 and "KilledWorker" in rows[3]["error"], rows
    assert [row["square"] for row in rows if row["index"] != 3] == [0, 1, 4, 16, 25, 36, 49]


def diagnosed(program, records, out, rig):
    """A batch of diagnoses: a row for each record, one of them with the reason why it cannot be read."""
    options = ["--effects", "01"]
    with batch.client(workers=2) as connected:
        work, failed = diagnoses.diagnoses(connected, records, program, rig, clean(out / "diagnoses"), options)
    rows = {row["record"]: row for row in work.table().to_pylist()}
    assert failed == 1 and rows.keys() == {"broken", "friction"}, rows
    assert "exit code 1" in rows["broken"]["error"] and "train.csv" in rows["broken"]["error"], rows
    named = rows["friction"]
    assert named["verdict"] == "identified" and named["parameter"] == "strut.coulomb.force", named
    assert named["low"] <= 60.0 <= named["high"], named
    # The command finds it all there, as what it is told to hand on is the same.
    command = [sys.executable, diagnoses.__file__, records, "--diagnose", program, "--rig", rig, "--workers", "1"]
    command += ["--out", out / "diagnoses", "--", *options]
    told = subprocess.run(command, check=True, capture_output=True, text=True)
    assert "2 of 2 are there already" in told.stderr and "2 records, 1 with an error" in told.stdout, told
    print(f"diagnoses: {named['summary']}")


if __name__ == "__main__":
    match sys.argv[1]:
        case "sweep":
            swept(Path(sys.argv[2]), sys.argv[3], Path(sys.argv[4]))
            survived(Path(sys.argv[4]))
        case "diagnoses":
            diagnosed(sys.argv[2], Path(sys.argv[3]), Path(sys.argv[4]), sys.argv[5])
