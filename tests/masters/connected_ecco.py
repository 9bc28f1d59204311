"""libcosim's ecco, which adapts its step, against the monolithic references.

    python connected_ecco.py FOLDER

The systems are given in OSP's own format. A power bond is the actuator's force on the rig and the velocity at which it acts.
ecco takes steps between a tenth of the fixed one and the fixed one, so its error must not be larger than the fixed
step's, which is estimated as in connected.py: twice the difference to half the step. Roads are left out: they know
nothing of the coupling, and between ecco's steps they could only be interpolated.
"""

import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from connected import MARGIN
from connected_systems import Reference, compose
from matrix_jobs import system

BONDS = {
    "tum-active": [("rig.suspension.velocity", "motor.suspension.velocity"), ("motor.force", "rig.actuator.force")],
    "ajala-two-dof": [
        ("rig.suspension.velocity", "actuator.suspension.velocity"), ("actuator.force", "rig.actuator.force"),
    ],
}  # fmt: skip
SETTINGS = {
    "SafetyFactor": 0.99, "MinimumChangeRate": 0.2, "MaximumChangeRate": 1.5, "ProportionalGain": 0.2,
    "IntegralGain": 0.15, "RelativeTolerance": 1e-4, "AbsoluteTolerance": 1e-4,
}  # fmt: skip


def structure(job, bond, folder):
    """The file of a system in OSP's format."""
    root = ElementTree.Element(
        "OspSystemStructure", xmlns="http://opensimulationplatform.com/MSMI/OSPSystemStructure", version="0.1"
    )
    for name, value in (("BaseStepSize", job.step), ("Algorithm", "ecco")):
        ElementTree.SubElement(root, name).text = str(value)
    simulators = ElementTree.SubElement(root, "Simulators")
    for name, path in job.components.items():
        ElementTree.SubElement(simulators, "Simulator", name=name, source=Path(path).as_uri())
    connections = ElementTree.SubElement(root, "Connections")
    for ends in job.connections:
        bonded = {"powerBond": "strut"} if ends in bond else {}
        connection = ElementTree.SubElement(connections, "VariableConnection", bonded)
        for end, causality in zip(ends, ("output", "input")):
            simulator, variable = end.split(".", 1)
            told = {"causality": causality} if bonded else {}
            ElementTree.SubElement(connection, "Variable", {"simulator": simulator, "name": variable} | told)
    configuration = ElementTree.SubElement(root, "EccoConfiguration")
    steps = {"StepSize": job.step, "MinimumStepSize": 0.1 * job.step, "MaximumStepSize": job.step}
    for name in ("SafetyFactor", *steps, *list(SETTINGS)[1:]):
        ElementTree.SubElement(configuration, name).text = repr((SETTINGS | steps)[name])
    path = Path(folder) / "OspSystemStructure.xml"
    ElementTree.ElementTree(root).write(path, xml_declaration=True, encoding="utf-8")
    return path


def run(path, job, stop, signals):
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.ERROR)
    execution = CosimExecution.from_osp_config_file(str(path))
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    slaves = []
    for signal in signals:
        name, variable = signal.split(".", 1)
        index = execution.slave_index_from_instance_name(name)
        slaves.append((index, {v.name.decode(): v.reference for v in execution.slave_variables(index)}[variable]))
    times, rows = [0.0], [[np.nan] * len(signals)]
    while times[-1] < stop:
        assert execution.step(), "a step failed"
        times.append(execution.status().current_time * 1e-9)
        rows.append([observer.last_real_values(index, [reference])[0] for index, reference in slaves])
    return np.array(times), np.array(rows)


def main():
    folder = Path(sys.argv[1])
    print("| system | steps | shortest, longest step in ms | worst signal | error | with a fixed step of 1 ms |")
    print("|---|--:|--:|---|--:|--:|")
    for name, bond in BONDS.items():
        reference = Reference(name)
        stop = reference.stop + 2.0 * reference.step
        with tempfile.TemporaryDirectory() as unpacked:
            job = system(folder / f"{name}.ssp", unpacked)
            times, rows = run(structure(job, bond, unpacked), job, stop, reference.signals)

        def own(step):
            with compose(name, folder) as composed:
                return reference.at_rows(composed.run(stop, step, reference.signals), step)

        whole, half = own(reference.step), own(0.5 * reference.step)
        steps = np.diff(times)
        found = {}
        for column, signal in enumerate(reference.signals):
            if signal.split(".", 1)[0] == "road":
                continue
            # What a tick puts out is seen at the end of the step that begins there.
            wanted = reference.times + reference.step * (signal in reference.case["ticked"])
            rows_there = np.interp(wanted, times[1:], rows[1:, column])
            error = reference.scaled(signal, rows_there - reference.values[signal])
            found[signal] = error, 2.0 * reference.scaled(signal, whole[signal] - half[signal])
        worst = max(found, key=lambda signal: found[signal][0] / found[signal][1])
        error, estimate = found[worst]
        print(f"| {name} | {len(steps)} | {1e3 * steps.min():.2g}, {1e3 * steps.max():.2g} | {worst} | {error:.1e} "
              f"| {estimate:.1e} |")
        failures = [signal for signal, (error, estimate) in found.items() if not error <= MARGIN * estimate]
        assert not failures, f"{name}: worse than the fixed step: {failures}"


if __name__ == "__main__":
    main()
