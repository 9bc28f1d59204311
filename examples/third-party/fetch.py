"""Fetches the FMUs of others that the systems in this folder are made of.

    python fetch.py FOLDER

Some lie in the wheel of gemseo-fmu 3.1.1 (PyPI, LGPL), with binaries for linux64. Only the wheel is downloaded, nothing
of it is installed. Others PythonFMU makes of the models `truck_*.py`. The systems' files are copied beside them.
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
    here = Path(__file__).resolve().parent
    for model in sorted(here.glob("truck_*.py")):
        build = [sys.executable, "-m", "pythonfmu", "build", "--file", str(model), "--dest", str(folder)]
        subprocess.run(build, check=True, stdout=subprocess.DEVNULL)
    for system in sorted(here.glob("*.toml")):
        (folder / system.name).write_bytes(system.read_bytes())


if __name__ == "__main__":
    fetch(Path(sys.argv[1]))
