"""A system with FMUs of others in libcosimpy and Ecos, against our own master.

    python third_party.py SYSTEM.ssp

FMPy passes over the start values in a system's file, without which these are other systems.
"""

import sys
import tempfile
from pathlib import Path

from matrix_jobs import off, system
from matrix_masters import Ecos, Libcosimpy

sys.path.insert(0, str(Path(__file__).parent.parent.parent / "examples" / "third-party"))
from leave import leave  # noqa: E402

# Rounding, amplified by what is simulated.
TOLERANCE = 1e-9


def main():
    path = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as unpacked:
        job = system(path, unpacked)
        job.count = 5000
        for master in Libcosimpy("libcosimpy", ""), Ecos("ecos", ""):
            rows, scheme = master.run("ssp", path, job)
            apart = off(rows, job.run(scheme))
            print(f"{master.name}: {path.stem}, {len(job.signals)} signals, {apart:.1e}")
            assert apart <= TOLERANCE, apart


if __name__ == "__main__":
    main()
    leave()
