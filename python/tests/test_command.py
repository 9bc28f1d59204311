"""The commands that the package brings, without cargo."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import strut

BIN = Path(sys.executable).parent


def run(*command):
    done = subprocess.run([BIN / command[0], *command[1:]], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def test_an_fmu_of_a_parameter_set_needs_no_cargo(tmp_path):
    Path("soft.toml").write_text(
        'fmu = "SoftRig"\nmodel = "QuarterCar"\ntitle = "A soft one"\nsource = "tried"\n'
        '[values]\nstrut.stiffness = { value = 5000.0, unit = "N/m", source = "tried" }\n'
    )
    code, told, error = run("strut", "fmu", "--parameters", "soft.toml")
    assert code == 0 and "SoftRig" in told, error
    assert Path("fmus/SoftRig.fmu").is_file()
    code, told, error = run("build-fmu", "TumRoad", "quanser-lqr", "--out", "others")
    assert code == 0, error
    assert {it.name for it in Path("others").iterdir()} == {"TumRoad.fmu", "quanser-lqr.ssp"}
    code, told, error = run("strut", "check", "others/quanser-lqr.ssp", "--no-fmpy")
    assert code == 0, told + error


def test_where_there_is_neither_a_library_nor_cargo_the_message_says_what_to_do(tmp_path):
    code, _, error = run("strut", "fmu", "TumRoad", "--target", "aarch64-unknown-linux-gnu")
    assert code == 1 and not Path("fmus").exists()
    for part in ["no cargo", "install Rust", "has no library for aarch64-unknown-linux-gnu of fmu-road"]:
        assert part in error
    (tmp_path / "empty").mkdir()
    code, _, error = run("strut", "fmu", "TumRoad", "--libraries", "empty")
    assert code == 1 and "no cargo" in error and "--libraries" in error


@pytest.mark.parametrize("command", [["strut", "diagnose"], ["diagnose"]])
def test_old_and_new_names_are_the_same_program(command):
    code, told, _ = run(*command, "rigs")
    assert code == 0 and [line.split()[0] for line in told.splitlines()] == strut.rigs()


def test_the_version_names_the_program():
    code, told, _ = run("strut", "--version")
    assert code == 0 and told.strip() == f"strut {strut.__version__}"


def test_ctrl_c_ends_a_diagnosis_and_leaves_nothing_half_written(tmp_path):
    assert run("diagnose", "simulate", "--hide", "strut.coulomb.force=60")[0] == 0
    command = [BIN / "diagnose", "--rig", "tum-linear-measured-quarter-car"]
    command += ["--train", "records/train.csv", "--test", "records/test.csv", "--out", "report"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stderr.readline()
    time.sleep(1.0)
    start = time.monotonic()
    process.send_signal(signal.SIGINT)
    process.wait(timeout=10)
    assert time.monotonic() - start < 1.0 and process.returncode != 0
    assert not Path("report").exists() or not list(Path("report").iterdir())
