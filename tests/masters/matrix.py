"""Every FMU and every system in every master: a table of how far each result is from the reference.

    python matrix.py FOLDER [--short] [--masters NAMES] [--page FILE] [--cofmupy PYTHON] [--fmi-sim PROGRAM]
        [--fmi-crate PROGRAM] [--fmusim PROGRAM] [--omsimulator PROGRAM] [--pyfmi PYTHON]

The reference is our own master (examples/jacobi.py), which calls the FMUs through FMPy's bare functions; where a master
exchanges values at other instants than it, the same scheme is written down in ten lines, so that what is compared is
arithmetic and not taste. What the FMUs do alone is held against independent solutions by `fmpy_references.py`.

A cell is the largest difference of any signal, relative to its largest value. `--short` runs some of each kind in all masters,
and every FMU of FMI 2.0 in three of them.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import matrix_jobs
import matrix_masters
from connected_all import APART
from matrix_page import page

# Rounding, amplified by what is simulated.
TOLERANCE = 1e-9
# The same kinks as in tum-rig, by themselves, and an orifice's root: within the error control's tolerance. With that at
# 1e-11 both are below 2e-12. A piston that runs on the ends of its stroke: with a tolerance of 1e-12 it is below 5e-10.
KINKED = APART | {"ExcitationMotor": 1e-7, "KoniecznyLoadedServoHydraulicActuator": 1e-7, "PneumaticCylinder": 1e-7}

SHORT = {
    "TumQuarterVehicle", "KogutSasRig", "LinearMotor", "QuanserLqrController", "TumLiveSensorChain", "RecordedRoad",
    "FourWheelRoad", "SignalAdapter", "quanser-lqr", "tum-active", "konieczny-open-loop",
}  # fmt: skip
# Without a file its signal rests, and nothing would be compared; `augmented.py` runs one with a record.
RESTING = {"RecordedSource"}
# What every FMU of FMI 2.0 runs in, however short.
QUICK = {"FMPy", "libcosimpy", "ecos"}


def jobs(folder, short, unpacked):
    for path in sorted(folder.glob("*.fmu")):
        if path.stem in RESTING:
            continue
        job = matrix_jobs.single(path)
        yield "fmu", path, job
        if not short or path.stem in SHORT:
            # The same job with the FMU of FMI 3.0; what it is to come to is what that of FMI 2.0 does.
            if (later := folder / "fmi3" / path.name).exists():
                yield "fmi3", later, job
    for path in sorted(folder.glob("*.ssp")):
        if not short or path.stem in SHORT:
            yield "ssp", path, matrix_jobs.system(path, Path(unpacked) / path.stem)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="where the FMUs and systems are")
    parser.add_argument("--short", action="store_true", help="not every FMU in every master")
    parser.add_argument("--masters", metavar="NAMES", help="these only, such as FMPy,ecos")
    parser.add_argument("--page", type=Path, help="file to write the table to")
    parser.add_argument("--cofmupy", metavar="PYTHON", help="a Python that has cofmupy")
    parser.add_argument("--fmi-sim", metavar="PROGRAM", help="the program fmi-sim")
    parser.add_argument("--fmi-crate", metavar="PROGRAM", help="examples/rust-master's program `job`")
    parser.add_argument("--fmusim", metavar="PROGRAM", help="modelica's program fmusim")
    parser.add_argument("--omsimulator", metavar="PROGRAM", help="OMSimulator's command line")
    parser.add_argument("--pyfmi", metavar="PYTHON", help="a Python that has PyFMI")
    arguments = parser.parse_args()
    begin = time.monotonic()
    masters = [master for make in matrix_masters.ALL if (master := make(arguments))]
    if arguments.masters:
        wanted = arguments.masters.split(",")
        masters = [master for master in masters if master.name in wanted]
        assert len(masters) == len(wanted), f"of {wanted} only {[master.name for master in masters]} are here"
    table, failures = {}, []
    with tempfile.TemporaryDirectory() as unpacked:
        for kind, path, job in jobs(arguments.folder, arguments.short, unpacked):
            references = {}
            row = table[kind, job.name] = {}
            for master in masters:
                if arguments.short and job.name not in SHORT and master.name not in QUICK:
                    continue
                reason = master.cannot(kind, job)
                if kind == "fmi3" and not master.fmi3:
                    reason = matrix_masters.ONE
                if reason:
                    row[master.name] = reason
                    continue
                try:
                    rows, scheme = master.run(kind, path, job)
                    if rows is None:
                        row[master.name] = 0.0
                        continue
                    if scheme not in references:
                        references[scheme] = job.run(scheme)
                    row[master.name] = matrix_jobs.off(rows, references[scheme])
                except Exception as error:
                    failures.append(f"{master.name}, {job.name}: {error}")
                    row[master.name] = float("inf")
                    continue
                if not row[master.name] <= KINKED.get(job.name, TOLERANCE):
                    failures.append(f"{master.name}, {job.name}: {row[master.name]:.1e} apart")
            title = f"{job.name} (FMI 3.0)" if kind == "fmi3" else job.name
            print(title, *(f"{name}: {cell:.0e}" if isinstance(cell, float) else f"{name}: -"
                           for name, cell in row.items()), flush=True)
    assert table, f"no FMUs in {arguments.folder}"
    print(f"{sum(isinstance(cell, float) for row in table.values() for cell in row.values())} runs")
    if arguments.page:
        ecco = subprocess.run([sys.executable, Path(__file__).with_name("connected_ecco.py"), arguments.folder],
                              check=True, capture_output=True, text=True).stdout
        minutes = f"{max(1, round((time.monotonic() - begin) / 60.0))} min"
        page(arguments.page, table, masters, minutes, ecco.strip())
    if failures:
        sys.exit("\n".join(failures))


if __name__ == "__main__":
    main()
