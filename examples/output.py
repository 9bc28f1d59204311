"""What the examples share apart from the importer: where FMUs are found and where pictures go."""

import argparse
from pathlib import Path

import matplotlib
from PIL import Image

# The pictures go into files; a display is not needed.
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

plt.rcParams.update({"axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False, "axes.spines.right": False})

FMUS = Path(__file__).resolve().parent.parent / "fmus"


def folders(description):
    """The folders from the command line: the FMUs', and the pictures'."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmus", type=Path, default=FMUS, help="folder of the FMUs (default: %(default)s)")
    parser.add_argument("--out", type=Path, help="folder for the picture (default: pictures, in that folder)")
    arguments = parser.parse_args()
    out = arguments.out or arguments.fmus / "pictures"
    out.mkdir(parents=True, exist_ok=True)
    return arguments.fmus, out


def save(figure, path):
    figure.savefig(path, dpi=110)
    plt.close(figure)
    # A palette is enough for lines, and makes the file a third as large.
    with Image.open(path) as image:
        palette = image.convert("RGB").quantize(64)
    palette.save(path, optimize=True)
    print(f"picture: {path}")
