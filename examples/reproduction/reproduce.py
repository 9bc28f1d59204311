"""The published numbers and figures, ours beside them, as one page.

    python reproduce.py [--fmus FOLDER] [--out FOLDER]

Writes README.md and pictures/ into this folder, or where --out says. Fails if a number does not come out
and no reason for it is known, or if a claim does not hold; then nothing is written.
"""

import argparse
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import output  # noqa: E402
import ajala  # noqa: E402
import kogut  # noqa: E402
import konieczny  # noqa: E402
import quanser  # noqa: E402
import tum  # noqa: E402

HEAD = """# Reproduction

Every published number and what the figures claim, read off the FMUs. `scripts/long-tests examples` makes this page again and compares it.

```
python examples/reproduction/reproduce.py
```

✓: agrees to the printed digits. ✗: does not, and why. At the end of each section stand the printed numbers that nothing
is calculated for, as the FMUs have them, and those that cannot be compared. What a source quotes of other works is left
out."""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmus", type=Path, default=output.FMUS, help="folder of the FMUs (default: %(default)s)")
    parser.add_argument("--out", type=Path, default=HERE, help="folder of the page (default: %(default)s)")
    arguments = parser.parse_args()
    sections = [source.section(arguments.fmus) for source in (tum, quanser, konieczny, ajala, kogut)]
    failures = [f"{section.title}: {failure}" for section in sections for failure in section.failures()]
    if failures:
        sys.exit("\n".join(failures))
    pictures = arguments.out / "pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    for section in sections:
        for figure in section.figures:
            output.save(figure.draw(), pictures / figure.file)
    lines = [HEAD, "", *(line for section in sections for line in section.lines())]
    (arguments.out / "README.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")
    print(f"page: {arguments.out / 'README.md'}")


if __name__ == "__main__":
    main()
