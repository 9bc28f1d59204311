"""Fetches the FMUs of others that the systems in this folder are made of.

    python fetch.py FOLDER

They lie in the wheel of gemseo-fmu 3.1.1 (PyPI, LGPL), with binaries for linux64. Only the wheel is downloaded, nothing
of it is installed. The systems' files are copied beside them.
"""

import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path, PurePosixPath

PACKAGE = "gemseo-fmu==3.1.1"
WHERE = "gemseo_fmu/problems/fmu_files/linux/"
FMUS = ["MassSpringSubSystem1.fmu", "Mass_Damper.fmu", "ramp.fmu"]


def fetch(folder):
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as download:
        pip = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
        subprocess.run([*pip, "--dest", download, PACKAGE], check=True)
        (wheel,) = Path(download).glob("*.whl")
        with zipfile.ZipFile(wheel) as archive:
            for name in FMUS:
                (folder / name).write_bytes(archive.read(str(PurePosixPath(WHERE) / name)))
    for system in sorted(Path(__file__).parent.glob("*.toml")):
        (folder / system.name).write_bytes(system.read_bytes())


if __name__ == "__main__":
    fetch(Path(sys.argv[1]))
