"""FMUs with several platforms: every library gives the same bits, and masters see what is in the file.

    python platforms.py FOLDER WORK PLATFORM...

FOLDER has the FMUs, WORK is for what is made here; a PLATFORM is a folder's name below `binaries/`. Each library
is run by `tests/platforms/host.c`, on this machine or where the platform is emulated.
"""

import os
import shutil
import struct
import subprocess
import sys
import zipfile
from pathlib import Path

from fmpy import supported_platforms
from fmpy.validation import validate_fmu
from rig import STEP, all_fmus

STEPS = 400
SOURCES = Path(__file__).parent.parent / "platforms"

# What compiles the host, what runs it, and how a library is called.
PLATFORMS = {
    "linux64": ("cc", [], ".so"),
    "win64": ("x86_64-w64-mingw32-gcc", ["wine"], ".dll"),
    "aarch64-linux": ("aarch64-linux-gnu-gcc", ["qemu-aarch64-static", "-L", "/usr/aarch64-linux-gnu"], ".so"),
}
# FMPy 0.3.32 lists none but Intel's.
LISTED = {"linux64", "win64"}


def bits(value):
    return struct.pack(">d", value).hex()


def script(fmu):
    """What the host is to do: the excitation of all checks."""
    lines = []
    for variables in (fmu.inputs, fmu.outputs):
        lines.append(" ".join(str(number) for number in [len(variables), *(v.valueReference for v in variables)]))
    lines.append(f"{STEPS} {bits(STEP)}")
    lines += [" ".join(bits(value) for value in fmu.excitation(step * STEP)) for step in range(STEPS)]
    return "\n".join(lines)


def compile_host(platform, work):
    compiler, _, ending = PLATFORMS[platform]
    source = SOURCES / "host.c"
    if ending == ".dll":
        host = work / "host.exe"
        subprocess.run([compiler, "-O1", "-o", host, source], check=True)
        lacking = "bcryptprimitives"
        subprocess.run(
            [compiler, "-O1", "-shared", "-o", work / f"{lacking}.dll", SOURCES / f"{lacking}.c", "-ladvapi32"], check=True
        )
    else:
        host = work / f"host-{platform}"
        subprocess.run([compiler, "-O1", "-o", host, source, "-ldl"], check=True)
    return host


def play(fmu, platform, host, folder, work, with_resources):
    """What the host prints: every bit of outputs, derivatives and a saved state."""
    _, runner, ending = PLATFORMS[platform]
    library = folder / "binaries" / platform / f"{fmu.name}{ending}"
    drive = "Z:" if ending == ".dll" else ""
    location = (folder / "resources").as_posix().replace(" ", "%20")
    resources = f"file:///{drive}{location}".replace("////", "///") if with_resources else "-"
    environment = dict(os.environ, WINEPREFIX=str(work / "wine"), WINEDEBUG="-all")
    # libclang's folder is for this machine only.
    environment.pop("LD_LIBRARY_PATH", None)
    done = subprocess.run(
        [*runner, host, f"{drive}{library}", fmu.description.guid, resources, f"{drive}{work / 'script'}"],
        env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, f"{fmu.name} for {platform}: {done.stderr}"
    return done.stdout


def same_as_fmpy(fmu, text):
    """The outputs are those of FMPy, which shares no line with the host."""
    with fmu.running() as instance:
        rows = fmu.run(instance, 0, STEPS)
    expected = [" ".join(bits(value) for value in row) for row in rows]
    printed = [line.strip() for line in text.splitlines()[:STEPS]]
    assert printed == expected, f"{fmu.name}: the host and FMPy disagree"


def check(fmu, hosts, work):
    with zipfile.ZipFile(fmu.path) as archive:
        carried = {name.split("/")[1] for name in archive.namelist() if name.startswith("binaries/")}
    assert carried == set(hosts), (carried, set(hosts))
    assert set(supported_platforms(str(fmu.path))) == LISTED & carried
    problems = validate_fmu(str(fmu.path))
    assert not problems, problems
    # A path as users have them.
    folder = work / "my models" / fmu.name
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(fmu.folder, folder)
    (work / "script").write_text(script(fmu))
    expected = play(fmu, "linux64", hosts["linux64"], folder, work, True)
    same_as_fmpy(fmu, expected)
    for platform, host in hosts.items():
        for with_resources in (True, False):
            text = play(fmu, platform, host, folder, work, with_resources)
            differing = [pair for pair in zip(expected.splitlines(), text.splitlines()) if pair[0] != pair[1]]
            assert text == expected, f"{fmu.name} for {platform} differs in {len(differing)} lines: {differing[:1]}"
        print(f"{fmu.name}: {platform}, {STEPS} steps, the same bits")


def main():
    fmus, work = sys.argv[1], Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    hosts = {platform: compile_host(platform, work) for platform in sys.argv[3:]}
    for fmu in all_fmus(fmus):
        try:
            check(fmu, hosts, work)
        finally:
            fmu.close()


if __name__ == "__main__":
    main()
