"""Checks of every FMU of FMI 3.0 beside the same one of FMI 2.0. One function, one claim; run by the Rust tests.

    python fmi3_checks.py CHECK FOLDER

FOLDER has the FMUs of FMI 2.0; those of FMI 3.0 are in its folder `fmi3`.
"""

import ctypes
import sys
import zipfile
from pathlib import Path

import fmpy
import numpy as np
from excitation import excitation
from fmpy import read_model_description, simulate_fmu
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu
from lxml import etree

STEP = 1e-3
STEPS = 200
# One of each kind, for what takes long.
SOME = [
    "QuarterCar", "TumQuarterVehicle", "KogutMrRotaryBrake", "KoniecznyServoSuspension", "QuanserLqrController",
    "TumVelocityEstimator", "RecordedRoad", "KoniecznyChirpVoltage",
]  # fmt: skip


def driven(description):
    """The inputs' values over time, or none."""
    inputs = [v for v in description.modelVariables if v.causality == "input"]
    times = np.arange(STEPS + 1) * STEP
    signals = np.zeros(len(times), dtype=[("time", float)] + [(v.name, float) for v in inputs])
    signals["time"] = times
    for v in inputs:
        signals[v.name] = [float(v.start) + excitation(v.name, v.unit, time) for time in times]
    return signals if inputs else None


def simulated(path, kind="CoSimulation", **options):
    """What FMPy records of an FMU."""
    signals = driven(read_model_description(str(path)))
    return simulate_fmu(
        str(path), fmi_type=kind, stop_time=STEPS * STEP, output_interval=STEP, step_size=STEP, input=signals, **options
    )


def validate(two, three):
    """FMPy finds no problem, the terminals are as the schema wants, and every member is a variable."""
    if two.stem in SOME:
        problems = validate_fmu(str(three))
        assert not problems, problems
    else:
        # All but the grammar of names, which takes FMPy a second an FMU: they are those of FMI 2.0.
        read_model_description(str(three), validate=True, validate_model_structure=True)
    schema = etree.XMLSchema(etree.parse(Path(fmpy.__file__).parent / "schema/fmi3/fmi3TerminalsAndIcons.xsd"))
    with zipfile.ZipFile(three) as archive:
        names = archive.namelist()
        terminals = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml")).getroottree()
        root = etree.fromstring(archive.read("modelDescription.xml"))
    assert schema.validate(terminals), schema.error_log
    assert "terminalsAndIcons/icon.png" in names, names
    licences = {name for name in names if name.startswith("documentation/licenses/")}
    assert licences <= {"documentation/licenses/license.txt"}, licences
    declared = {v.get("name"): v for v in root.find("ModelVariables")}
    for member in terminals.iter("TerminalMemberVariable"):
        assert declared[member.get("variableName")].get("causality") in ("input", "output"), member.get("variableName")
    # Nothing of FMI 2.0 is lost, and the points of a table are one variable.
    old = read_model_description(str(two))
    for variable in old.modelVariables:
        assert variable.name in declared or variable.name.split("[")[0] in declared, variable.name
    assert old.guid == root.get("instantiationToken")


def same_bits(two, three):
    """Steps lead to the same bits in both versions."""
    expected, found = simulated(two), simulated(three)
    assert expected.dtype == found.dtype
    assert expected.tobytes() == found.tobytes()


def same_bits_in_model_exchange(two, three):
    """An importer that integrates gets the same bits from both versions."""
    if two.stem in SOME:
        assert simulated(two, "ModelExchange").tobytes() == simulated(three, "ModelExchange").tobytes()


def event_mode(two, three):
    """Who handles events gets to each tick; where inputs rest, that changes nothing."""
    description = read_model_description(str(three))
    options = dict(stop_time=STEPS * STEP, output_interval=10 * STEP)
    if not description.coSimulation.mightReturnEarlyFromDoStep:
        return
    # Inputs at their starts, which FMPy never touches.
    plain = simulate_fmu(str(three), **options)
    handled = simulate_fmu(str(three), use_event_mode=True, early_return_allowed=True, **options)
    # One kind is sampled only with a setting.
    assert len(handled) > len(plain) or "ServoHydraulic" in two.stem, "no step ended at a tick"
    for name in plain.dtype.names[1:]:
        # The first of several rows of a time is before the event.
        rows = np.searchsorted(handled["time"], plain["time"] - 1e-9)
        size = np.ptp(plain[name]) or 1.0
        assert np.allclose(handled[name][rows[1:]], plain[name][1:], rtol=1e-9, atol=1e-6 * size), name


class Instance:
    """An initialised instance of FMI 3.0 for co-simulation."""

    def __init__(self, path):
        self.description = read_model_description(str(path))
        self.folder = fmpy.extract(str(path))
        self.fmu = FMU3Slave(
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
        )
        self.fmu.instantiate()
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def sizes(self, variables):
        return sum(int(np.prod(v.shape)) if v.shape else 1 for v in variables)

    def derivative(self, function, unknowns, knowns, seed, size):
        references = [(ctypes.c_uint32 * len(of))(*(v.valueReference for v in of)) for of in (unknowns, knowns)]
        seeds, result = (ctypes.c_double * len(seed))(*seed), (ctypes.c_double * size)()
        (unknown, known) = references
        function(self.fmu.component, unknown, len(unknown), known, len(known), seeds, len(seed), result, size)
        return np.array(result)


def derivatives(_two, three):
    """Directional and adjoint derivatives are one Jacobian, by inputs, states and arrays of parameters."""
    instance = Instance(three)
    variables = instance.description.modelVariables
    rates = [unknown.variable for unknown in instance.description.derivatives]
    unknowns = rates + [v for v in variables if v.causality == "output" and v.initial == "calculated"]
    arrays = [v for v in variables if v.dimensions and v.causality == "parameter"]
    knowns = [v.derivative for v in rates] + [v for v in variables if v.causality == "input"] + arrays[:2]
    rows, columns = instance.sizes(unknowns), instance.sizes(knowns)
    by_column = [
        instance.derivative(instance.fmu.fmi3GetDirectionalDerivative, unknowns, knowns, seed, rows)
        for seed in np.eye(columns)
    ]
    by_row = [
        instance.derivative(instance.fmu.fmi3GetAdjointDerivative, unknowns, knowns, seed, columns)
        for seed in np.eye(rows)
    ]
    if rows and columns:
        assert np.array_equal(np.transpose(by_column), by_row)
    instance.fmu.terminate()
    instance.fmu.freeInstance()


def ecos(two, three):
    """Ecos gets the outputs that FMPy gets, where inputs are held away from their starts."""
    from ecospy import EcosSimulation, EcosSimulationStructure

    if two.stem not in SOME:
        return
    description = read_model_description(str(three))
    of = {c: [v for v in description.modelVariables if v.causality == c] for c in ("input", "output")}
    held = {v.name: float(v.start) + excitation(v.name, v.unit, 0.0123) for v in of["input"]}
    plain = simulate_fmu(str(three), start_values=held, stop_time=STEPS * STEP, output_interval=STEP, step_size=STEP)
    with EcosSimulationStructure() as structure:
        structure.add_model("fmu", str(three))
        structure.add_parameter_set("held", {f"fmu::{name}": value for name, value in held.items()})
        with EcosSimulation(STEP, structure=structure) as simulation:
            simulation.init(parameter_set="held")
            for row in plain[1:]:
                simulation.step()
                found = [simulation.get_real(f"fmu::{v.name}") for v in of["output"]]
                expected = [row[v.name] for v in of["output"]]
                assert np.allclose(found, expected, rtol=1e-12, atol=1e-12), (found, expected)
            simulation.terminate()


def fmutool(two, three):
    """The FMU manipulation toolbox has no complaints."""
    from matrix_masters import Fmutool

    if two.stem in SOME:
        Fmutool("fmutool", "").run("fmu", three, None)


CHECKS = [validate, same_bits, same_bits_in_model_exchange, event_mode, derivatives, ecos, fmutool]


def main():
    check = {check.__name__: check for check in CHECKS}[sys.argv[1]]
    for two in sorted(Path(sys.argv[2]).glob("*.fmu")):
        try:
            check(two, two.parent / "fmi3" / two.name)
        except Exception as error:
            raise AssertionError(f"{two.stem}: {check.__doc__}") from error
        print(f"{check.__name__}: {two.stem}", flush=True)


if __name__ == "__main__":
    main()
