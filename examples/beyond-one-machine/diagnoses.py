"""A batch of diagnoses, on as many machines as there are.

    python diagnoses.py RECORDS --diagnose PROGRAM --rig RIG --out FOLDER [--scheduler ADDRESS | --workers N] [-- OPTIONS]

RECORDS is a folder of folders, each with a train.csv and a test.csv, as `diagnose simulate` makes them. Each becomes a row
with the verdict and the first cause; the reports go beside the records' rows. What follows `--` is handed to `diagnose`.
With a scheduler elsewhere, PROGRAM, RECORDS and FOLDER have to be where all workers see them.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import batch
import cloudpickle
import pyarrow as pa

cloudpickle.register_pickle_by_value(sys.modules[__name__])

SCHEMA = [
    ("record", pa.string()),
    ("verdict", pa.string()),
    ("summary", pa.string()),
    ("causes", pa.list_(pa.string())),
    ("parameter", pa.string()),
    ("value", pa.float64()),
    ("low", pa.float64()),
    ("high", pa.float64()),
    ("seconds", pa.float64()),
]
# A diagnosis takes minutes; an hour is a mistake.
PATIENCE = 3600


def diagnose(task):
    """On a worker: one diagnosis."""
    record, command, out = task
    try:
        ended = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    except subprocess.TimeoutExpired:
        return {"record": record, "error": f"no end after {PATIENCE} s"}
    if ended.returncode != 0:
        told = ended.stderr.strip().splitlines() or ["no message"]
        return {"record": record, "error": f"exit code {ended.returncode}: {' '.join(told[-4:])}"}
    report = json.loads((Path(out) / "report.json").read_text())
    row = {key: report[key] for key in ("verdict", "summary", "seconds")}
    row |= {"record": record, "causes": [effect["name"] for effect in report["effects"]]}
    parameters = [parameter for effect in report["effects"] for parameter in effect["parameters"]]
    if parameters:
        row["parameter"] = parameters[0]["name"]
        row |= {key: parameters[0][key] for key in ("value", "low", "high")}
    return row


def diagnoses(connected, records, program, rig, out, options=(), part=1, done=lambda number: None):
    """Runs what is missing; returns the batch and the number of rows with an error."""
    out = Path(out).resolve()
    folders = sorted(path.parent.resolve() for path in Path(records).glob("*/train.csv"))
    if not folders:
        sys.exit(f"{records} has no folders with a train.csv: make some with `diagnose simulate`")
    plan = {"records": [folder.name for folder in folders], "rig": rig, "options": list(options)}
    work = batch.Batch(out, plan, len(folders), part)

    def task(index):
        folder, report = folders[index], out / "reports" / folders[index].name
        command = [str(Path(program).resolve()), "--rig", rig, "--train", str(folder / "train.csv")]
        command += ["--test", str(folder / "test.csv"), "--no-fmu", "--jobs", "1", "--out", str(report), *options]
        return folder.name, command, str(report)

    return work, work.run(connected, diagnose, task, SCHEMA, done)


def main():
    parser = argparse.ArgumentParser(
        usage="%(prog)s RECORDS --diagnose PROGRAM --rig RIG --out FOLDER [options] [-- OPTIONS]",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("records", type=Path)
    parser.add_argument("--diagnose", type=Path, required=True, help="the program, as `cargo build --release` makes it")
    parser.add_argument("--rig", required=True, help="as in `diagnose rigs`")
    parser.add_argument("--out", type=Path, required=True, help="folder for the results")
    parser.add_argument("--scheduler", help="address of a Dask scheduler (default: a cluster on this machine)")
    parser.add_argument("--workers", type=int, help="processes of the cluster on this machine (default: one a core)")
    # argparse itself gives up on `--` behind other options.
    given = sys.argv[1:]
    end = given.index("--") if "--" in given else len(given)
    arguments, options = parser.parse_args(given[:end]), given[end + 1 :]
    with batch.client(arguments.scheduler, arguments.workers) as connected:
        work, failed = diagnoses(
            connected, arguments.records, arguments.diagnose, arguments.rig, arguments.out, options
        )
    for row in work.table().to_pylist():
        print(f"{row['record']}: {row['error'] or row['summary']}")
    print(f"{work.count} records, {failed} with an error; results in {arguments.out}")


if __name__ == "__main__":
    main()
