"""A parameter sweep of the QuarterCar over a kerb, on as many machines as there are.

    python sweep.py FMU [--sets 10000 | --from SETS.csv] --out FOLDER [--scheduler ADDRESS | --workers N]

Each set of parameters is one run of the FMU through FMPy: the wheel starts on a kerb of 20 mm, and what matters in the two
seconds after it becomes a row. Without --from the sets fill the ranges below evenly (Latin hypercube).
"""

import argparse
import csv
import hashlib
import io
import shutil
import sys
import tempfile
import time
import zipfile
from pathlib import Path

import batch
import cloudpickle
import numpy as np
import pyarrow as pa
from distributed import WorkerPlugin, get_worker
from scipy.stats import qmc

cloudpickle.register_pickle_by_value(sys.modules[__name__])

RANGES = {
    "sprung_mass": (250.0, 450.0),
    "unsprung_mass": (30.0, 60.0),
    "strut.stiffness": (15e3, 30e3),
    "strut.damping": (800.0, 3e3),
    "tire.stiffness": (150e3, 250e3),
}
KERB, STEP, STOP = 0.02, 5e-3, 2.0
OUTPUTS = ["body.acceleration", "suspension.deflection", "wheel.force"]
PEAKS = [f"peak {name}" for name in OUTPUTS]
SCHEMA = [(name, pa.float64()) for name in [*RANGES, *PEAKS]]


def latin_hypercube(count, seed):
    low, high = np.array(list(RANGES.values())).T
    return qmc.scale(qmc.LatinHypercube(len(RANGES), rng=seed).random(count), low, high)


def read_sets(path):
    with open(path, newline="") as file:
        header, *lines = csv.reader(file)
        if header != list(RANGES):
            sys.exit(f"{path}: the first line has to be `{','.join(RANGES)}`")
        return np.array([[float(number) for number in line] for line in lines])


def write_sets(path, sets):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(RANGES)
        writer.writerows([repr(float(number)) for number in row] for row in sets)


class Fmu(WorkerPlugin):
    """Brings the FMU to every worker, also to those that come later, and keeps an instance there."""

    name = "strut-fmu"

    def __init__(self, content):
        self.content = content

    def setup(self, worker):
        from fmpy import read_model_description
        from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

        self.folder = tempfile.mkdtemp()
        with zipfile.ZipFile(io.BytesIO(self.content)) as archive:
            archive.extractall(self.folder)
        description = read_model_description(self.folder)
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.messages = []
        # Both are kept: the FMU calls the logger as long as it lives.
        self.logger = fmi2CallbackLoggerTYPE(lambda *call: self.messages.append(call[4].decode()))
        self.callbacks = fmi2CallbackFunctions(logger=self.logger)
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="sweep",
        )
        self.slave.instantiate(callbacks=self.callbacks)
        worker.strut_fmu = self

    def teardown(self, worker):
        self.slave.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    def simulate(self, numbers):
        """The peaks of one run."""
        slave = self.slave
        self.messages.clear()
        try:
            slave.reset()
            slave.setupExperiment(startTime=0.0)
            slave.setReal([self.references[name] for name in RANGES], numbers)
            slave.setReal([self.references["road.position"]], [KERB])
            slave.enterInitializationMode()
            slave.exitInitializationMode()
            told = [self.references[name] for name in OUTPUTS]
            peaks = np.abs(slave.getReal(told))
            for number in range(round(STOP / STEP)):
                slave.doStep(currentCommunicationPoint=number * STEP, communicationStepSize=STEP)
                peaks = np.maximum(peaks, np.abs(slave.getReal(told)))
        except Exception as error:
            raise RuntimeError("; ".join(self.messages) or str(error)) from None
        return [float(peak) for peak in peaks]


def simulate(numbers):
    """On a worker: one set of parameters."""
    peaks = get_worker().strut_fmu.simulate(numbers)
    return dict(zip([*RANGES, *PEAKS], [*numbers, *peaks]))


def sweep(connected, fmu, sets, out, part=100, done=lambda number: None):
    """Runs what is missing; returns the batch and the number of rows with an error."""
    content = Path(fmu).read_bytes()
    digest = hashlib.sha256(content + sets.tobytes()).hexdigest()
    work = batch.Batch(out, {"fmu": Path(fmu).name, "sha256 of FMU and sets": digest}, len(sets), part)
    connected.register_plugin(Fmu(content))
    failed = work.run(connected, simulate, lambda index: sets[index].tolist(), SCHEMA, done)
    return work, failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmu", type=Path, help="QuarterCar.fmu")
    parser.add_argument("--sets", type=int, default=10_000, help="how many (default: %(default)s)")
    parser.add_argument("--from", dest="given", type=Path, help="a CSV file with sets of your own")
    parser.add_argument("--seed", type=int, default=1, help="of the Latin hypercube (default: %(default)s)")
    parser.add_argument("--save-sets", type=Path, help="writes the sets into a CSV file, for the Rust program")
    parser.add_argument("--out", type=Path, required=True, help="folder for the results")
    parser.add_argument("--scheduler", help="address of a Dask scheduler (default: a cluster on this machine)")
    parser.add_argument("--workers", type=int, help="processes of the cluster on this machine (default: one a core)")
    arguments = parser.parse_args()
    sets = read_sets(arguments.given) if arguments.given else latin_hypercube(arguments.sets, arguments.seed)
    if arguments.save_sets:
        write_sets(arguments.save_sets, sets)
    with batch.client(arguments.scheduler, arguments.workers) as connected:
        start, workers = time.perf_counter(), len(connected.scheduler_info()["workers"])
        _, failed = sweep(connected, arguments.fmu, sets, arguments.out)
        seconds = time.perf_counter() - start
    print(f"{len(sets)} sets on {workers} workers, {failed} with an error: {seconds:.2f} s, results in {arguments.out}")


if __name__ == "__main__":
    main()
