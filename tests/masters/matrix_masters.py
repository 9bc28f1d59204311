"""The masters of the matrix: how each is told a job, and what it cannot do.

Each has `name`, `version`, `cannot(kind, job)`: why it does not run something, and `run(kind, path, job)`: rows
after every step, and the scheme of our own master that they are to agree with (None, None if it only checks).
"""

import contextlib
import logging
import re
import subprocess
import tempfile
import zipfile
from collections import Counter
from importlib.metadata import version
from pathlib import Path

import numpy as np
from connected import MASTERS, ExchangedAfterwards
from matrix_jobs import ContinuousFirst, InDependencyOrder, InTurn, System, ZeroAtFirst
from other_python import OtherPython

# What a master of single FMUs, or of systems, does not run.
ONE = "one"


class Master:
    """Of one name and version; without restrictions, but for FMI 3.0."""

    # Whether it is given FMUs of FMI 3.0.
    fmi3 = False

    def __init__(self, name, release):
        self.name, self.version = name, release

    def cannot(self, kind, job):
        return None


class Fmpy(Master):
    fmi3 = True

    def run(self, kind, path, job):
        if kind == "ssp":
            return columns(MASTERS["fmpy"][0], path, job), ZeroAtFirst
        from fmpy import simulate_fmu

        start = {name.split(".", 1)[1]: value for name, value in job.values.items()}
        names = [signal.split(".", 1)[1] for signal in job.signals]
        result = simulate_fmu(str(path), fmi_type="CoSimulation", start_values=start, output=names, step_size=job.step,
                              stop_time=job.count * job.step, output_interval=job.step)
        return np.array([result[name][1 : job.count + 1] for name in names]).T, System


def columns(master, path, job):
    """What a master of `connected.py` records, without the row for the start."""
    result = master(path, job.step, job.count, job.signals)
    return np.array([result[signal][1:] for signal in job.signals]).T


class Libcosimpy(Master):
    def run(self, kind, path, job):
        if kind == "ssp":
            return columns(MASTERS["libcosimpy"][0], path, job), System
        from libcosimpy.CosimExecution import CosimExecution
        from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
        from libcosimpy.CosimObserver import CosimObserver
        from libcosimpy.CosimSlave import CosimLocalSlave

        log_output_level(CosimLogLevel.ERROR)
        execution = CosimExecution.from_step_size(round(job.step * 1e9))
        slave = execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name="fmu"))
        references = {f"fmu.{v.name.decode()}": v.reference for v in execution.slave_variables(slave)}
        for name, value in job.values.items():
            execution.real_initial_value(slave, references[name], value)
        observer = CosimObserver.create_last_value()
        assert execution.add_observer(observer)
        rows = []
        for _ in range(job.count):
            assert execution.step(), "a step failed"
            rows.append(observer.last_real_values(slave, [references[signal] for signal in job.signals]))
        return np.array(rows), System


class Ecos(Master):
    fmi3 = True

    def run(self, kind, path, job):
        if kind == "ssp":
            return columns(MASTERS["ecos"][0], path, job), ExchangedAfterwards
        from ecospy import EcosSimulation, EcosSimulationStructure

        named = [signal.replace(".", "::", 1) for signal in job.signals]
        with EcosSimulationStructure() as structure:
            structure.add_model("fmu", str(path))
            structure.add_parameter_set(
                "held", {name.replace(".", "::", 1): value for name, value in job.values.items()}
            )
            with EcosSimulation(job.step, structure=structure) as simulation:
                simulation.init(parameter_set="held")
                rows = []
                for _ in range(job.count):
                    simulation.step()
                    rows.append([simulation.get_real(name) for name in named])
                simulation.terminate()
        return np.array(rows), System


class Fmutool(Master):
    """Checks single FMUs."""

    fmi3 = True

    def cannot(self, kind, job):
        return ONE if kind == "ssp" else None

    def run(self, kind, path, job):
        from fmu_manipulation_toolbox.checker import get_checkers
        from fmu_manipulation_toolbox.operations import FMU

        complaints = []
        handler = logging.Handler(logging.WARNING)
        handler.emit = lambda record: complaints.append(record.getMessage())
        logger = logging.getLogger("fmu_manipulation_toolbox")
        logger.addHandler(handler)
        try:
            fmu = FMU(str(path))
            for checker in get_checkers():
                fmu.apply_operation(checker())
        finally:
            logger.removeHandler(handler)
        assert not complaints, complaints
        return None, None


class Fmucontainer(Master):
    """Makes one FMU of a system, which then runs in FMPy."""

    def cannot(self, kind, job):
        return ONE if kind == "fmu" else None

    def run(self, kind, path, job):
        from fmpy import simulate_fmu
        from fmu_manipulation_toolbox.assembly import Assembly

        with tempfile.TemporaryDirectory() as folder:
            target = Path(folder) / path.name
            target.write_bytes(path.read_bytes())
            Assembly(target.name, default_step_size=job.step, fmu_directory=Path(folder), default_auto_local=True
                     ).make_fmu()
            (made,) = Path(folder).glob("*.fmu")
            # It names what is inside by file, and numbers those of one file.
            stems, seen = {}, Counter()
            for name, file in job.components.items():
                stem = Path(file).stem.lower()
                stems[name] = f"{stem}-{seen[stem]}" if seen[stem] else stem
                seen[stem] += 1
            ends = [signal.split(".", 1) for signal in job.signals]
            names = [f"{stems[component]}.{variable}" for component, variable in ends]
            result = simulate_fmu(str(made), fmi_type="CoSimulation", output=names, step_size=job.step,
                                  stop_time=job.count * job.step, output_interval=job.step)
        return np.array([result[name][1 : job.count + 1] for name in names]).T, System


class Cofmupy(Master):
    def __init__(self, python):
        self.python = OtherPython(python, "matrix_cofmupy.py", "cofmupy")
        super().__init__("cofmupy", self.python.version)

    def run(self, kind, path, job):
        return self.python.run(job.fields()), InTurn


class PyFmi(Master):
    def __init__(self, python):
        self.python = OtherPython(python, "matrix_pyfmi.py", "PyFMI")
        super().__init__("PyFMI", self.python.version)

    def run(self, kind, path, job):
        rows = self.python.run(job.fields() | {"tolerance": ContinuousFirst.TOLERANCE})
        return rows, ContinuousFirst if kind == "ssp" else System


@contextlib.contextmanager
def without_units(kind, path):
    """An FMU of FMI 3.0 without units and nominal values: fmi-schema 0.8.0, by which the crate `fmi` and fmi-sim read
    descriptions, knows neither, and refuses what it does not know (`unknown field "unit" in element "FmiFloat64"`)."""
    if kind != "fmi3":
        yield path
        return
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / path.name
        with zipfile.ZipFile(path) as source, zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
            for entry in source.infolist():
                content = source.read(entry)
                if entry.filename == "modelDescription.xml":
                    text = re.sub("<UnitDefinitions>.*</UnitDefinitions>", "", content.decode(), flags=re.DOTALL)
                    content = re.sub(' (unit|nominal)="[^"]*"', "", text).encode()
                archive.writestr(entry, content)
        yield target


class FmiSim(Master):
    """Runs single FMUs."""

    fmi3 = True

    def __init__(self, program):
        # It tells its version as an error.
        told = subprocess.run([program, "--version"], capture_output=True, text=True)
        super().__init__("fmi-sim", re.search(r"fmi-sim ([0-9.]+)", told.stdout + told.stderr)[1])
        self.program = program

    def cannot(self, kind, job):
        return ONE if kind == "ssp" else None

    def run(self, kind, path, job):
        values = [f"{name.split('.', 1)[1]}={value!r}" for name, value in job.values.items()]
        values = [part for value in values for part in ("--init-values", value)]
        with tempfile.TemporaryDirectory() as folder, without_units(kind, path) as path:
            rows = Path(folder) / "rows.csv"
            done = subprocess.run(
                [self.program, "--model", path, "-o", rows, "co-simulation", "--step", str(job.step),
                 "--output-interval", str(job.step), "-n", "0", "-s", "0", "-f", str(job.count * job.step), *values],
                capture_output=True, text=True,
            )  # fmt: skip
            assert done.returncode == 0, done.stderr[-500:]
            found = np.genfromtxt(rows, delimiter=",", names=True, deletechars="")
        return np.array([found[signal.split(".", 1)[1]][1 : job.count + 1] for signal in job.signals]).T, System


class Fmusim(Master):
    """Validates and runs single FMUs: the tool of the Reference FMUs."""

    fmi3 = True

    def __init__(self, program):
        told = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout
        super().__init__("fmusim", told.split()[1])
        self.program = program

    def cannot(self, kind, job):
        return ONE if kind == "ssp" else None

    def run(self, kind, path, job):
        said = self.told("validate", path)
        complaints = [line for line in said.splitlines() if not line.strip().startswith("Validating ")]
        assert not complaints, complaints
        names = [signal.split(".", 1)[1] for signal in job.signals]
        options = [("--start-value", f"{name.split('.', 1)[1]}={value!r}") for name, value in job.values.items()]
        options += [("--output-variable", name) for name in names]
        with tempfile.TemporaryDirectory() as folder:
            rows = Path(folder) / "rows.csv"
            self.told("simulate", path, "--interface-type=cs", f"--stop-time={job.count * job.step!r}",
                      f"--output-interval={job.step!r}", f"--output-file={rows}", *(it for pair in options for it in pair))
            found = np.genfromtxt(rows, delimiter=",", names=True, deletechars="")
        return np.array([found[name][1 : job.count + 1] for name in names]).T, System

    def told(self, *arguments):
        done = subprocess.run([self.program, *arguments], capture_output=True, text=True)
        assert done.returncode == 0, (done.stdout + done.stderr)[-500:]
        return done.stdout + done.stderr


class OMSimulator(Master):
    """Runs systems, by its command line."""

    def __init__(self, program):
        told = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout
        super().__init__("OMSimulator", re.search(r"v(\S+)", told)[1])
        self.program = str(Path(program).resolve())

    def cannot(self, kind, job):
        return ONE if kind == "fmu" else None

    def run(self, kind, path, job):
        with tempfile.TemporaryDirectory() as folder:
            rows = Path(folder) / "rows.csv"
            done = subprocess.run(
                [self.program, f"--stopTime={job.count * job.step!r}", f"--tolerance={InDependencyOrder.TOLERANCE!r}",
                 f"--intervals={job.count}", "--emitEvents=false", "--stripRoot=true", f"--resultFile={rows}", path.resolve()],
                cwd=folder, capture_output=True, text=True,
            )  # fmt: skip
            # It goes on after an error, and then tells so.
            errors = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith(("error", "warning"))]
            assert done.returncode == 0 and not errors, errors or done.returncode
            names = rows.read_text().partition("\n")[0].replace('"', "").split(",")
            found = np.loadtxt(rows, delimiter=",", skiprows=1)
        places = [names.index(signal) for signal in job.signals]
        return found[1 : job.count + 1, places], InDependencyOrder


class FmiCrate(Master):
    """The crate `fmi`, as examples/rust-master uses it."""

    fmi3 = True

    def __init__(self, program):
        super().__init__("fmi (crate)", "0.8")
        self.program = program

    def run(self, kind, path, job):
        with without_units(kind, path) as path:
            return self.told(job, {"fmu": path.resolve()} if kind == "fmi3" else job.components)

    def told(self, job, components):
        lines = [f"component\t{name}\t{file}" for name, file in components.items()]
        lines += [f"connect\t{source}\t{target}" for source, target in job.connections]
        lines += [f"set\t{name}\t{value!r}" for name, value in job.values.items()]
        lines += [f"signal\t{signal}" for signal in job.signals] + [f"run\t{job.step!r}\t{job.count}"]
        done = subprocess.run([self.program], input="\n".join(lines), capture_output=True, text=True)
        assert done.returncode == 0, done.stderr[-500:]
        rows = np.array([[float(cell) for cell in line.split("\t")] for line in done.stdout.splitlines()])
        return rows[1:], System


def installed(kind, name, package):
    def make(_arguments):
        with contextlib.suppress(ImportError):
            return kind(name, version(package))

    return make


ALL = [
    installed(Fmpy, "FMPy", "FMPy"),
    installed(Libcosimpy, "libcosimpy", "libcosimpy"),
    installed(Ecos, "ecos", "ecospy"),
    installed(Fmutool, "fmutool", "fmu-manipulation-toolbox"),
    installed(Fmucontainer, "fmucontainer", "fmu-manipulation-toolbox"),
    lambda arguments: arguments.cofmupy and Cofmupy(arguments.cofmupy),
    lambda arguments: arguments.fmi_sim and FmiSim(arguments.fmi_sim),
    lambda arguments: arguments.fmi_crate and FmiCrate(arguments.fmi_crate),
    lambda arguments: arguments.fmusim and Fmusim(arguments.fmusim),
    lambda arguments: arguments.omsimulator and OMSimulator(arguments.omsimulator),
    lambda arguments: arguments.pyfmi and PyFmi(arguments.pyfmi),
]
