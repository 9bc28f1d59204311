"""Builds the wheel: maturin builds the module; the command and the libraries of all models are put beside it first.

`STRUT_TARGET=x86_64-unknown-linux-gnu.2.17` builds it for that platform instead of this machine. It is packed here then: maturin would
compile everything once more, with another linker. `STRUT_PROFILE=dev` compiles module
and command by the development profile, which is faster to build and slower to run. The libraries in the FMUs are the same in
either case.
"""

import base64
import hashlib
import json
import os
import shutil
import subprocess
import tempfile
import zipfile
from pathlib import Path

import maturin
from maturin import (  # noqa: F401  (the hooks of PEP 517 that need nothing more)
    build_sdist,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    prepare_metadata_for_build_wheel,
)
from toolchain import Toolchain

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python" / "strut"
MANIFEST = ["--manifest-path", str(ROOT / "Cargo.toml")]


def get_requires_for_build_wheel(config_settings=None):
    return maturin.get_requires_for_build_wheel(config_settings) + _toolchain().requires


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    toolchain = _toolchain()
    _prepare(toolchain)
    if toolchain.target is None:
        return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)
    return _packed(Path(wheel_directory), toolchain, _artefacts(_profile(), toolchain) / toolchain.module[0])


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    _prepare(Toolchain())
    return maturin.build_editable(wheel_directory, config_settings, metadata_directory)


def _toolchain():
    return Toolchain(os.environ.get("STRUT_TARGET") or None)


def _profile():
    return os.environ.get("STRUT_PROFILE", "release")


def _prepare(toolchain):
    """Puts the command and the libraries into the package."""
    profile = _profile()
    if profile != "dev":
        os.environ.setdefault("STRUT_VERSION", _version())
    os.environ.setdefault("MATURIN_PEP517_ARGS", f"--profile {profile}")
    # Makes the libraries, for whatever platform: with this machine's compiler, to run here.
    packager = None if toolchain.runs_here else _built("dev", Toolchain())
    os.environ.update(toolchain.environment)
    command = _built(profile, toolchain)
    for folder in ("bin", "libraries"):
        shutil.rmtree(PACKAGE / folder, ignore_errors=True)
    (PACKAGE / "bin").mkdir()
    placed = PACKAGE / "bin" / toolchain.program
    shutil.copy2(command, placed)
    libraries = [str(packager or placed), "fmu", "libraries", "--out", str(PACKAGE / "libraries"), *toolchain.cargo]
    _run(libraries, CARGO_MANIFEST_DIR=str(ROOT / "build-fmu"))


def _built(profile, toolchain):
    """The command, built."""
    cargo = os.environ.get("CARGO", "cargo")
    # Both at once: of one package alone, cargo would choose other features of their common dependencies, and compile those again.
    packages = ["--package", "strut-command", "--package", "strut-python"]
    _run([cargo, toolchain.subcommand, "--profile", profile, *MANIFEST, *packages, *toolchain.cargo])
    return _artefacts(profile, toolchain) / toolchain.program


def _artefacts(profile, toolchain):
    """The folder that cargo builds into."""
    cargo = os.environ.get("CARGO", "cargo")
    metadata = subprocess.check_output([cargo, "metadata", "--no-deps", "--format-version=1", *MANIFEST])
    target = Path(json.loads(metadata)["target_directory"], toolchain.triple or "")
    return target / ("debug" if profile == "dev" else profile)


def _packed(folder, toolchain, module):
    """The wheel of a platform, of the package's files and a module."""
    files = {f"strut/{toolchain.module[1]}": module}
    own = (it for it in PACKAGE.rglob("*") if it.is_file() and "__pycache__" not in it.parts)
    files |= {it.relative_to(PACKAGE.parent).as_posix(): it for it in own if it.suffix != ".so" or "libraries" in it.parts}
    tag = f"cp310-abi3-{toolchain.tag}"
    with tempfile.TemporaryDirectory() as place:
        information = prepare_metadata_for_build_wheel(place)
        text = f"Wheel-Version: 1.0\nGenerator: strut\nRoot-Is-Purelib: false\nTag: {tag}\n"
        Path(place, information, "WHEEL").write_text(text, encoding="utf-8")
        Path(place, information, "RECORD").unlink(missing_ok=True)
        files |= {it.relative_to(place).as_posix(): it for it in sorted(Path(place).rglob("*")) if it.is_file()}
        name = f"{information.removesuffix('.dist-info')}-{tag}.whl"
        record = []
        with zipfile.ZipFile(folder / name, "w", zipfile.ZIP_DEFLATED) as wheel:
            for path, file in files.items():
                contents = file.read_bytes()
                digest = base64.urlsafe_b64encode(hashlib.sha256(contents).digest()).rstrip(b"=").decode()
                record.append(f"{path},sha256={digest},{len(contents)}\n")
                _add(wheel, path, contents)
            record.append(f"{information}/RECORD,,\n")
            _add(wheel, f"{information}/RECORD", "".join(record).encode())
    return name


def _add(wheel, path, contents):
    entry = zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0))
    entry.compress_type = zipfile.ZIP_DEFLATED
    # As a regular file: pip keeps the bit of a program only then.
    entry.external_attr = (0o100755 if path.startswith("strut/bin/") else 0o100644) << 16
    wheel.writestr(entry, contents)


def _run(command, **variables):
    subprocess.run(command, cwd=ROOT, check=True, env=os.environ | variables)


def _version():
    """The version, with the commit if this is a checkout: `0.1.0 (1a2b3c4d5e6f)`."""
    manifest = (ROOT / "Cargo.toml").read_text(encoding="utf-8")
    version = manifest.split("[workspace.package]")[1].split('version = "')[1].split('"')[0]
    git = ["git", "-C", str(ROOT), "describe", "--always", "--dirty=+", "--exclude=*", "--abbrev=12"]
    try:
        commit = subprocess.check_output(git, stderr=subprocess.DEVNULL, text=True).strip()
    except (OSError, subprocess.CalledProcessError):
        return version
    return f"{version} ({commit})"
