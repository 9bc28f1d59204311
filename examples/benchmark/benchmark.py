"""What does a communication step of each FMU cost, and what does it cost SUNDIALS?

    python benchmark.py FOLDER|FMU ... [--steps 1000] [--step 0.001] [--runs 5] [--write README.md]
    python benchmark.py FMU ... --peer THEIRS.fmu ... [--tolerance 1e-6]

prints one Markdown table. Each FMU is driven from a C host whose inputs are those of tests/masters/excitation.py,
held from communication point to communication point. Times are the processor's, medians of runs that alternate.

For an FMU with states the same right-hand side is integrated by SUNDIALS (sundials.c), called through the FMU's
model exchange side and restarted at every communication point, since the inputs jump there. Both run over a ladder
of tolerances; compared are the times at equal error. CVODE is given the best of its variants, FMU by FMU: BDF or
Adams; Newton's iteration with difference quotients or with the FMU's exact derivatives, or functional iteration.
Multistep methods start slowly, so ARKODE's explicit Runge-Kutta method of Dormand and Prince stands beside it.

With --peer the FMUs of other exporters are timed beside ours, at one tolerance.

Needs Python 3 and a C compiler; for SUNDIALS its version 6 (Debian: `apt-get install libsundials-dev`). Linux, macOS.
"""

import argparse
import math
import statistics
import struct
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parents[1] / "tests" / "masters"))
from excitation import AMPLITUDE, excitation  # noqa: E402

SUNDIALS = "cvode arkode nvecserial sunlinsoldense sunmatrixdense sunnonlinsolfixedpoint".split()
VARIANTS = {
    "BDF": {"method": "bdf", "iteration": "newton"},
    "BDF, exact Jacobian": {"method": "bdf", "iteration": "exact"},
    "Adams, Newton": {"method": "adams", "iteration": "newton"},
    "Adams, exact Jacobian": {"method": "adams", "iteration": "exact"},
    "Adams": {"method": "adams", "iteration": "fixed"},
}
# An error that a user would ask for, as a fraction of a state's range.
USUAL = 1e-6


class Fmu:
    """An unpacked FMU and the arguments of the hosts."""

    def __init__(self, path, folder, options):
        self.name = path.stem
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        root = ElementTree.parse(folder / "modelDescription.xml").getroot()
        slave = root.find("CoSimulation")
        if slave is None:
            raise SystemExit(f"{path}: it has no co-simulation side")
        library = next(folder.glob(f"binaries/*64/{slave.get('modelIdentifier')}.*"))
        variables = root.findall("ModelVariables/ScalarVariable")
        real = [v for v in variables if v.find("Real") is not None]
        rates = [variables[int(u.get("index")) - 1] for u in root.findall("ModelStructure/Derivatives/Unknown")]
        states = [variables[int(v[0].get("derivative")) - 1] for v in rates]
        inputs = [v for v in real if v.get("causality") == "input"]
        outputs = [v for v in real if v.get("causality") == "output"] or real
        experiment = root.find("DefaultExperiment")
        experiment = {} if experiment is None else experiment.attrib
        step = options.step or float(experiment.get("stepSize", 1e-3))
        # Other exporters do not always tell the unit.
        driven = [v for v in inputs if v[0].get("unit") in AMPLITUDE]
        if len(driven) < len(inputs):
            print(f"{self.name}: inputs without an amplitude in excitation.py rest", file=sys.stderr)
        numbers = [
            float(v[0].get("start", 0.0)) + excitation(v.get("name"), v[0].get("unit"), index * step)
            for index in range(options.steps)
            for v in driven
        ]
        signals = folder / "excitation"
        signals.write_bytes(struct.pack(f"{len(numbers)}d", *numbers))
        self.states = len(states)
        self.inputs, self.outputs = len(inputs), len(outputs)
        self.tells_cost = any(c.get("name") == "logSolver" for c in root.findall("LogCategories/Category"))
        method = next((v[0].get("start") for v in variables if v.get("name") == "solver.method"), None)
        self.method = {"1": "explicit", "2": "Rosenbrock"}.get(method, "–")
        tolerance = next((v[0].get("start") for v in variables if v.get("name") == "solver.tolerance"), None)
        self.tolerance = tolerance and float(tolerance)
        references = {"inputs": driven, "outputs": outputs, "states": states, "rates": rates}
        self.arguments = [
            f"library={library}",
            f"guid={root.get('guid')}",
            f"resources={(folder / 'resources').as_uri()}",
            f"step={step!r}",
            f"steps={options.steps}",
            f"excitation={signals}",
            *(f"{key}={','.join(v.get('valueReference') for v in list)}" for key, list in references.items()),
        ]


def run(host, fmu, **options):
    arguments = [f"{key}={value}" for key, value in options.items()]
    result = subprocess.run([str(host), *arguments, *fmu.arguments], capture_output=True, text=True)
    if result.returncode:
        raise SystemExit(f"{fmu.name}: {' '.join(arguments)}\n{result.stderr}")
    return result.stdout


class Ladder:
    """What a run of both solvers over all tolerances gave."""

    def __init__(self, text):
        rows = {"fmu": {}, "peer": {}}
        for line in text.splitlines():
            who, *numbers = line.split()
            numbers = [float(number) for number in numbers]
            if who in rows:
                rows[who].setdefault(numbers[0], []).append(numbers[1:])
            else:
                setattr(self, who, numbers[0])
        self.fmu, self.peer = ({key: median(runs) for key, runs in rows[who].items()} for who in ("fmu", "peer"))


def median(runs):
    """The median time; errors and counts are the same in every run."""
    error, _, *counts = runs[0]
    return [error, statistics.median(run[1] for run in runs), *counts]


def at_error(rungs, error):
    """Time and counts at an error, between the two tolerances that come nearest; those of the cheapest tolerance if
    all are more accurate, none if no tolerance is as accurate."""
    rows = sorted((row for row in rungs.values() if row[1] < math.inf), key=lambda row: row[0])
    # A tolerance that is less accurate and dearer is nobody's choice.
    best = [row for row in rows if row[1] <= min(other[1] for other in rows if other[0] <= row[0])]
    below = [row for row in best if row[0] <= error]
    above = [row for row in best if row[0] > error]
    if not below or not above or not below[-1][0]:
        return below[-1] if below else None
    part = math.log(error / below[-1][0]) / math.log(above[0][0] / below[-1][0])
    return [(1.0 - part) * a + part * b for a, b in zip(below[-1], above[0])]


def compare(host, fmu, options):
    """What the FMU's integration costs, and what SUNDIALS costs at the same error."""
    erk = Ladder(run(host, fmu, repeats=options.runs, method="erk"))
    error, ns, rates, steps, rejected, jacobians = erk.fmu[0.0]
    # Below the deviation of two tight results from each other no error is known.
    equal = max(error, 3.0 * erk.floor)

    def cost(name):
        row = at_error(Ladder(run(host, fmu, repeats=1, **VARIANTS[name])).peer, equal)
        return row[1] if row else math.inf

    name = min(VARIANTS, key=cost)
    ladder = Ladder(run(host, fmu, repeats=options.runs, **VARIANTS[name]))
    peer, usual = at_error(ladder.peer, equal), [at_error(rungs, USUAL) for rungs in (ladder.peer, ladder.fmu)]
    row = [f"{error:.0e}", f"{ns:.0f}", f"{rates:.1f}", f"{steps:.2f}", f"{rejected:.3f}", f"{jacobians:.2f}"]
    if peer:
        calls = peer[2] * ladder.call + peer[5] * ladder.matrix * (VARIANTS[name]["iteration"] == "exact")
        row += [name, f"{peer[1]:.0f}", f"{peer[2]:.0f}", f"{peer[1] / ladder.fmu[0.0][1]:.1f}"]
        row += [f"{(peer[1] - calls) / ladder.fmu[0.0][1]:.1f}"]
    else:
        row += ["not as accurate", "–", "–", "–", "–"]
    row += [f"{usual[0][1] / usual[1][1]:.1f}" if all(usual) else "–"]
    peer = at_error(erk.peer, equal)
    return [*row, f"{peer[1] / ns:.1f}" if peer else "–"]


HEADING = [
    "FMU", "in → out", "states", "method", "tolerance",
    "error", "ns", "rates", "steps", "rejected", "Jacobians",
    "CVODE", "ns", "rates", "ratio", "without calls", f"ratio at {USUAL:g}", "ERK ratio",
]  # fmt: skip


def markdown(rows):
    lines = ["| " + " | ".join(HEADING) + " |", "|---|---|--:|---|--:" + "|--:" * 6 + "|---" + "|--:" * 6 + "|"]
    return "\n".join(lines + ["| " + " | ".join(row + ["–"] * (len(HEADING) - len(row))) + " |" for row in rows]) + "\n"


def compiled(source, scratch, libraries):
    """A host; none if the compiler does not find what it needs."""
    host = scratch / Path(source).stem
    command = ["cc", "-O2", "-o", str(host), str(HERE / source), *(f"-l{name}" for name in libraries), "-ldl", "-lm"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode and libraries:
        return None
    if result.returncode:
        raise SystemExit(result.stderr)
    return host


def table(fmus, scratch, options):
    host = compiled("host.c", scratch, [])
    sundials = compiled("sundials.c", scratch, [f"sundials_{name}" for name in SUNDIALS])
    if not sundials:
        print("without SUNDIALS, which is not here (Debian: apt-get install libsundials-dev)", file=sys.stderr)
    rows = []
    for fmu in fmus:
        tolerance = f"{fmu.tolerance:g}" if fmu.states and fmu.tolerance else "–"
        row = [fmu.name, f"{fmu.inputs} → {fmu.outputs}", str(fmu.states), fmu.method if fmu.states else "–", tolerance]
        if fmu.states and fmu.tells_cost and sundials:
            row += compare(sundials, fmu, options)
        else:
            times = [float(run(host, fmu)) for _ in range(options.runs)]
            row += ["–", f"{statistics.median(times):.0f}"]
        rows.append(row)
        print(" ".join(row), file=sys.stderr)
    return markdown(rows)


def beside_peers(fmus, peers, scratch, options):
    host = compiled("host.c", scratch, [])
    everything = [*fmus, *peers]
    times = [[] for _ in everything]
    for _ in range(options.runs):
        for place, fmu in enumerate(everything):
            times[place].append(float(run(host, fmu, tolerance=options.tolerance)))
    lines = ["| FMU | ns a step |" + "".join(f" / {peer.name} |" for peer in peers), "|---|--:|" + "--:|" * len(peers)]
    for place, fmu in enumerate(everything):
        ratios = [statistics.median(a / b for a, b in zip(times[place], others)) for others in times[len(fmus):]]
        lines.append(f"| {fmu.name} | {statistics.median(times[place]):.1f} |" + "".join(f" {ratio:.2f} |" for ratio in ratios))
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmus", nargs="+", type=Path, help="FMUs, or folders of them")
    parser.add_argument("--peer", action="append", default=[], type=Path, help="another exporter's FMU")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="beside peers")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--step", type=float, help="communication step in seconds; else the default experiment's")
    parser.add_argument("--write", type=Path, help="a Markdown file whose table is replaced")
    options = parser.parse_args()
    paths = [file for path in options.fmus for file in (sorted(path.glob("*.fmu")) if path.is_dir() else [path])]
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        fmus = [Fmu(path, scratch / f"fmu{i}", options) for i, path in enumerate(paths)]
        peers = [Fmu(path, scratch / f"peer{i}", options) for i, path in enumerate(options.peer)]
        result = beside_peers(fmus, peers, scratch, options) if peers else table(fmus, scratch, options)
    print(result, end="")
    if options.write:
        write(options.write, result)


def write(path, result):
    """Replaces what stands between the two marks."""
    begin, end = "<!-- table: begin -->\n", "<!-- table: end -->"
    before, _, rest = path.read_text().partition(begin)
    _, mark, after = rest.partition(end)
    if not mark:
        raise SystemExit(f"{path} has no lines `{begin.strip()}` and `{end}`")
    path.write_text(before + begin + result + end + after)


if __name__ == "__main__":
    main()
