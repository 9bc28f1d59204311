"""One picture for every system, as one page.

    python gallery.py [--fmus FOLDER] [--out FOLDER]       makes README.md, numbers.json and pictures/
    python gallery.py --check SECONDS [--fmus FOLDER]      compares the first seconds of each with numbers.json
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from output import FMUS, plt, save  # noqa: E402
from ssp import open_system  # noqa: E402
from systems import PICTURES  # noqa: E402

STEP = 1e-3
# What is written down of each signal: that many values, evenly over the picture and what is before it.
SAMPLES = 40
# Other processors round otherwise, and the error control steps on (tolerances are 1e-7 and 1e-8).
AGREEMENT = 1e-5

HEAD = """# Gallery

One picture for every system in `fmus/*.ssp`, by the master of [jacobi.py](../jacobi.py). `cargo test` runs the first
second of each again and compares it with `numbers.json`.

```
python examples/gallery/gallery.py
```
"""


def simulate(picture, fmus, stop):
    with open_system(fmus, picture.system, picture.parameters) as system:
        return system.run(stop, STEP, picture.signals())


def sampled(picture, result):
    """Values at even distances, as far as the result reaches."""
    stride = round(picture.stop / SAMPLES / STEP)
    return {signal: [float(value) for value in result[signal][stride::stride]] for signal in picture.signals()}


def draw(picture, result):
    count = len(picture.panels)
    figure, axes = plt.subplots(count, 1, sharex=True, figsize=(8, 0.8 + 1.7 * max(count, 2)), layout="constrained", squeeze=False)
    shown = result["time"] >= picture.start - STEP / 2
    if picture.over:
        signal, label, scale = picture.over
        abscissa, limits = scale * result[signal][shown], None
    else:
        abscissa, label, limits = result["time"][shown], "time in s", (picture.start, picture.stop)
    for panel, axis in zip(picture.panels, axes[:, 0], strict=True):
        for line in panel.lines:
            values = panel.scale * result[line.signal][shown]
            axis.plot(abscissa, values, color=line.colour, linestyle=line.style, linewidth=1.2, label=line.label)
        axis.set_ylabel(panel.quantity)
        # Above the axes, where it is never over a line.
        place = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.1}
        axis.legend(ncols=len(panel.lines), frameon=False, handlelength=1.4, **place)
        if limits:
            axis.set_xlim(limits)
    axes[-1, 0].set_xlabel(label)
    figure.align_ylabels()
    return figure


def page():
    yield HEAD
    for picture in PICTURES:
        yield f"## {picture.system}\n\n{picture.sentence}\n\n![{picture.system}](pictures/{picture.system}.png)\n"


def make(fmus, out):
    (out / "pictures").mkdir(parents=True, exist_ok=True)
    numbers = {}
    for picture in PICTURES:
        result = simulate(picture, fmus, picture.stop)
        numbers[picture.system] = sampled(picture, result)
        save(draw(picture, result), out / "pictures" / f"{picture.system}.png")
    lines = [f'"{name}": {json.dumps(signals)}' for name, signals in numbers.items()]
    (out / "numbers.json").write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    (out / "README.md").write_text("\n".join(page()), encoding="utf-8")


def check(fmus, seconds):
    """The page is that of the systems there are, and its numbers are found again."""
    there, shown = {path.stem for path in fmus.glob("*.ssp")}, {picture.system for picture in PICTURES}
    assert there == shown, f"systems without picture: {there - shown}; pictures without system: {shown - there}"
    assert (HERE / "README.md").read_text(encoding="utf-8") == "\n".join(page()), "make the page again"
    numbers = json.loads((HERE / "numbers.json").read_text(encoding="utf-8"))
    failures = []
    for picture in PICTURES:
        assert (HERE / "pictures" / f"{picture.system}.png").is_file(), f"no picture of {picture.system}"
        stop = max(seconds, picture.stop / SAMPLES)
        compared, worst = 0, 0.0
        for signal, found in sampled(picture, simulate(picture, fmus, stop)).items():
            wanted = np.array(numbers[picture.system][signal])
            scale = np.abs(wanted).max()
            apart = np.abs(np.array(found) - wanted[: len(found)]).max() / (scale or 1.0)
            compared, worst = compared + len(found), max(worst, apart)
            if not apart <= AGREEMENT:
                failures.append((picture.system, signal, apart))
        assert compared, f"nothing of {picture.system} is compared"
        print(f"{picture.system}: {compared} numbers, {worst:.1e}")
    assert not failures, failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmus", type=Path, default=FMUS, help="folder of the FMUs (default: %(default)s)")
    parser.add_argument("--out", type=Path, default=HERE, help="folder of the page (default: %(default)s)")
    parser.add_argument("--check", type=float, metavar="SECONDS", help="compare, and make nothing")
    arguments = parser.parse_args()
    if arguments.check is None:
        make(arguments.fmus, arguments.out)
    else:
        check(arguments.fmus, arguments.check)


if __name__ == "__main__":
    main()
