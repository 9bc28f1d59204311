"""How much faster than real time does a connected system run?

    python system.py SYSTEM.ssp ... [--step 0.001] [--time 60] [--runs 5]

The FMUs of an SSP are driven through their C interface by a small Jacobi master in C (system.c) on one core:
everything that is connected is exchanged at every step. Time is the processor's, the best of some runs; the
parts are from a run of their own, with the wall clock, and hold the exchange of their component.
Needs Python 3 and a C compiler, nothing else. Linux and macOS.
"""

import argparse
import subprocess
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

SSD = "{http://ssp-standard.org/SSP1/SystemStructureDescription}"


class Component:
    """A component of a system: where its FMU is, what is read of it and what is fed to it."""

    def __init__(self, name, folder):
        self.name = name
        self.folder = folder
        self.root = ElementTree.parse(folder / "modelDescription.xml").getroot()
        self.references = {
            v.get("name"): v.get("valueReference") for v in self.root.findall("ModelVariables/ScalarVariable")
        }
        self.outputs, self.inputs = [], []

    def plan(self, places):
        """What system.c reads."""
        library = next(self.folder.glob(f"binaries/*64/{self.root.find('CoSimulation').get('modelIdentifier')}.*"))
        resources = (self.folder / "resources").as_uri()
        outputs = [self.references[name] for name in self.outputs]
        inputs = [f"{self.references[name]} {places[source]}" for name, source in self.inputs]
        return "\n".join(
            [
                f"component {self.name} {library} {self.root.get('guid')} {resources}",
                " ".join(["outputs", str(len(outputs)), *outputs]),
                " ".join(["inputs", str(len(inputs)), *inputs]),
            ]
        )


def components(ssp, folder):
    """The components of an SSP, unpacked into a folder. Each FMU once: its code is then shared as well."""
    with zipfile.ZipFile(ssp) as archive:
        archive.extractall(folder)
    root = ElementTree.parse(folder / "SystemStructure.ssd").getroot()
    found = {}
    for element in root.iter(f"{SSD}Component"):
        fmu = folder / element.get("source")
        unpacked = fmu.with_suffix("")
        if not unpacked.exists():
            with zipfile.ZipFile(fmu) as archive:
                archive.extractall(unpacked)
        found[element.get("name")] = Component(element.get("name"), unpacked)
    for connection in root.iter(f"{SSD}Connection"):
        source = connection.get("startElement"), connection.get("startConnector")
        if source[1] not in found[source[0]].outputs:
            found[source[0]].outputs.append(source[1])
        found[connection.get("endElement")].inputs.append((connection.get("endConnector"), source))
    return found.values()


def measure(host, ssp, step, steps, runs):
    """Nanoseconds of a step, and of each component."""
    with tempfile.TemporaryDirectory() as folder:
        parts = components(ssp, Path(folder))
        everything = [(part.name, name) for part in parts for name in part.outputs]
        places = {signal: place for place, signal in enumerate(everything)}
        plan = "\n".join(part.plan(places) for part in parts)
        command = [str(host), str(step), str(steps), str(runs)]
        output = subprocess.run(command, input=plan, check=True, capture_output=True, text=True).stdout
    total, *lines = output.splitlines()
    return float(total), {name: float(time) for name, time in (line.split() for line in lines)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("systems", nargs="+", type=Path)
    parser.add_argument("--step", type=float, default=1e-3, help="communication step in seconds")
    parser.add_argument("--time", type=float, default=60.0, help="simulated time in seconds")
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        host = Path(scratch) / "system"
        source = Path(__file__).with_name("system.c")
        subprocess.run(["cc", "-O2", "-o", str(host), str(source), "-ldl", "-lm"], check=True)
        for ssp in options.systems:
            steps = round(options.time / options.step)
            total, parts = measure(host, ssp, options.step, steps, options.runs)
            ratio = options.step / (1e-9 * total)
            print(f"{ssp.stem}: {total:.0f} ns a step of {1e3 * options.step:g} ms, {ratio:.0f} times real time")
            for name, time in sorted(parts.items(), key=lambda part: -part[1]):
                print(f"    {name:28}{time:10.0f} ns")


if __name__ == "__main__":
    main()
