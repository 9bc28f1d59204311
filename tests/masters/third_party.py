"""A system with FMUs of others in libcosimpy, Ecos and, if its program is named, OMSimulator, against our own master.

    python third_party.py SYSTEM.ssp [OMSIMULATOR]

FMPy passes over the start values in a system's file, without which these are other systems.
"""

import sys
import tempfile
from pathlib import Path

from matrix_jobs import off, system
from matrix_masters import Ecos, Libcosimpy, OMSimulator

sys.path.insert(0, str(Path(__file__).parent.parent.parent / "examples" / "third-party"))
from leave import leave  # noqa: E402

# Rounding, amplified by what is simulated: masters count time each in their own way, which moves a position by 2e-16 m. A velocity that is
# made of two positions 10 µs apart is then 2e-11 m/s off, and friction of 8 N that turns over within 13 mm/s 1.4e-8 N, 2e-9 of itself.
TOLERANCE = 1e-8


def main():
    path = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as unpacked:
        job = system(path, unpacked)
        job.count = 5000
        masters = [Libcosimpy("libcosimpy", ""), Ecos("ecos", ""), *map(OMSimulator, sys.argv[2:])]
        for master in masters:
            rows, scheme = master.run("ssp", path, job)
            apart = off(rows, job.run(scheme))
            print(f"{master.name}: {path.stem}, {len(job.signals)} signals, {apart:.1e}")
            assert apart <= TOLERANCE, apart


if __name__ == "__main__":
    main()
    leave()
