"""Two FMUs with a fast mode between them, in every way that a master can couple them.

    python hard_coupling.py [--fmus FOLDER] [--out FOLDER]

Writes README.md and pictures/ into this folder, or where --out says. Prints a line for every method and step: errors in
percent, and calls a step of what `case.KINDS` says.
"""

import argparse
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import case  # noqa: E402
import output  # noqa: E402

# The step that users want, and what must come out there, in percent.
USUAL, BOUND = 1e-3, 1.0
# Those that have to.
SOUND = [case.LOADED, *list(case.METHODS)[5:]]


def told(error):
    """An error of a cell, in percent."""
    return "<0.001" if error < 1e-3 else f"{error:.2g}"


def errors(run):
    return " / ".join(told(error) for error in run.errors)


def steps(run):
    return f"{run.calls['step']:.1f}"


def table(rows, cell, usual=()):
    """A row a method and a column a step, then columns of what is called at the usual step."""
    head = ["method", *(f"{1e3 * step:g} ms" for step in case.STEPS), *usual]
    yield "| " + " | ".join(head) + " |"
    yield "|---" * len(head) + "|"
    for name in case.METHODS:
        cells = [cell(rows[name, step]) if rows[name, step].works else "–" for step in case.STEPS]
        at_usual = rows[name, USUAL]
        cells += [f"{at_usual.calls[kind]:.1f}" if at_usual.works else "–" for kind in usual]
        yield "| " + " | ".join([name, *cells]) + " |"


def page(rows):
    unit = rows[next(iter(case.METHODS)), case.STEPS[0]].seconds
    tables = {
        "errors": table(rows, errors),
        "calls": table(rows, steps, case.KINDS[1:]),
        "times": table(rows, lambda run: f"{run.seconds / unit:.2f}"),
    }
    text = (HERE / "page.md").read_text(encoding="utf-8")
    for place, lines in tables.items():
        text = text.replace(f"<!-- {place} -->", f"<!-- {place} -->\n\n" + "\n".join(lines))
    return text


def ring(folder, path):
    """The oil, compressed at the start, swings against the masses: what the methods make of it."""
    plt, pressure, stop = output.plt, 1e6, 0.010
    truth = case.reference(folder, stop, pressure)
    panels = {
        "inputs from what has been": ["constant inputs (Jacobi)", "input derivatives", "Gauss–Seidel, rig first"],
        "inputs that are solved for": [
            "iteration, Anderson",
            "interface Jacobian, constant inputs",
            "interface Jacobian",
        ],
    }
    figure, axes = plt.subplots(1, 2, sharey=True, figsize=(9, 3.9), layout="constrained")
    for panel, (title, names) in zip(axes, panels.items()):
        panel.plot(1e3 * truth["time"], truth["one.actuator.force"], color="0.3", linewidth=1.2, label="in one FMU")
        for name, marker in zip(names, "osD"):
            with case.pair(folder, name, USUAL, pressure) as system:
                result = system.run(stop, USUAL, ["actuator.force"])
            points = 1e3 * result["time"], result["actuator.force"]
            panel.plot(*points, marker, markersize=5, linestyle=":", linewidth=0.8, label=name)
        panel.set(title=title, xlabel="time in ms", ylim=(-1500, 1500))
        panel.legend(loc="lower left", fontsize=8, framealpha=0.95)
    axes[0].set_ylabel("force of the actuator in N")
    output.save(figure, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmus", type=Path, default=output.FMUS, help="folder of the FMUs (default: %(default)s)")
    parser.add_argument("--out", type=Path, default=HERE, help="folder of the page (default: %(default)s)")
    arguments = parser.parse_args()
    truth, rows = case.reference(arguments.fmus), {}
    for name in case.METHODS:
        for step in case.STEPS:
            run = rows[name, step] = case.run(arguments.fmus, name, step, truth)
            numbers = [f"{error:.6e}" for error in run.errors] + [f"{run.calls[kind]:.3f}" for kind in case.KINDS]
            print("|".join([name, f"{1e3 * step:g}", *(numbers if run.works else "–")]))
    for name in SOUND:
        run = rows[name, USUAL]
        if not run.works or max(run.errors) > BOUND:
            sys.exit(f"{name}: {run.errors} % at {USUAL:g} s, more than {BOUND:g} %")
    pictures = arguments.out / "pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    ring(arguments.fmus, pictures / "ring.png")
    (arguments.out / "README.md").write_text(page(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
