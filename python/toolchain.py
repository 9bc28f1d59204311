"""What builds a wheel for a platform: a Rust with that target, a linker, and zig where a version of glibc is given.

Targets are named as for `strut fmu --target`: `x86_64-unknown-linux-gnu.2.17`, `x86_64-pc-windows-gnu`.
"""

import os
import shutil
import subprocess
from pathlib import Path


TARGETS = ["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu", "x86_64-pc-windows-gnu"]


class Missing(Exception):
    """What is not installed, and what to do."""


class Toolchain:
    """How cargo builds for a target; for this machine if there is none."""

    def __init__(self, target=None):
        self.target = target
        self.environment = {}
        if target is None:
            self.triple, self.glibc = None, None
            return
        self.triple, _, self.glibc = target.partition(".")
        if self.triple not in TARGETS:
            raise Missing(f"wheels are made for {', '.join(TARGETS)}; for {self.triple}, run `pip wheel .` on such a machine")
        if not _has(_rustc(), self.triple):
            cross = Path(os.environ.get("STRUT_CROSS") or "nowhere", "bin", "rustc")
            if not (cross.is_file() and _has(str(cross), self.triple)):
                raise Missing(
                    f"the Rust target {self.triple} is not installed; run `rustup target add {self.triple}`, or on Debian "
                    "build-fmu/cross/toolchain, and name its folder in STRUT_CROSS"
                )
            self.environment["RUSTC"] = str(cross)
        if self.triple == "x86_64-pc-windows-gnu":
            linker = "x86_64-w64-mingw32-gcc"
            if shutil.which(linker) is None:
                raise Missing(f"there is no {linker}; on Debian: apt-get install gcc-mingw-w64-x86-64-win32")
            self.environment["CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER"] = linker

    @property
    def requires(self):
        """Python packages that the build needs."""
        return ["cargo-zigbuild", "ziglang"] if self.glibc else []

    @property
    def cargo(self):
        """The words after `cargo` that build."""
        return [] if self.target is None else ["--target", self.target]

    @property
    def subcommand(self):
        return "zigbuild" if self.glibc else "build"

    @property
    def is_windows(self):
        return os.name == "nt" if self.triple is None else "windows" in self.triple

    @property
    def program(self):
        """How the command's file is called."""
        return "strut.exe" if self.is_windows else "strut"

    @property
    def module(self):
        """How cargo and Python call the module's file."""
        return ("_strut.dll", "_strut.pyd") if self.is_windows else ("lib_strut.so", "_strut.abi3.so")

    @property
    def tag(self):
        """The platform in a wheel's name."""
        processor = self.triple.split("-")[0]
        if self.is_windows:
            return "win_amd64"
        return f"manylinux_{self.glibc.replace('.', '_')}_{processor}" if self.glibc else f"linux_{processor}"

    @property
    def runs_here(self):
        """Whether this machine runs what is built."""
        return self.triple is None or f"host: {self.triple}\n" in _asked(_rustc(), "-vV")


def _rustc():
    return os.environ.get("RUSTC", "rustc")


def _has(rustc, triple):
    return Path(_asked(rustc, "--print", "sysroot").strip(), "lib", "rustlib", triple, "lib").is_dir()


def _asked(rustc, *words):
    try:
        return subprocess.check_output([rustc, *words], text=True)
    except FileNotFoundError:
        raise Missing(f"there is no {rustc}; install Rust (https://rustup.rs)") from None
