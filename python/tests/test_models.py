"""FMUs without a compiler: made from the package's libraries, read by FMPy, simulated here and there alike."""

import shutil
import zipfile

import fmpy
import numpy as np
import pandas as pd
import polars
import pytest

import strut
from strut import _check, _models


def test_an_fmu_with_other_values_is_made_without_cargo():
    assert shutil.which("cargo") is None and shutil.which("rustc") is None
    path = strut.fmu("TumQuarterVehicle", {"strut.stiffness": 9000, "tire.lift_off": False}, name="StiffRig")
    assert path.name == "StiffRig.fmu"
    description = fmpy.read_model_description(path)
    starts = {it.name: it.start for it in description.modelVariables}
    assert float(starts["strut.stiffness"]) == 9000.0 and starts["tire.lift_off"] == "false"
    assert not fmpy.validation.validate_fmu(path)


def test_every_model_and_system_can_be_listed_and_each_model_has_its_library():
    listed = strut.models()
    assert {"rig", "actuator", "controller", "system"} <= set(listed["kind"])
    for name in ["QuarterCar", "KoniecznyStepRoad", "RecordedRoad", "AjalaPidHForcePid"]:
        with zipfile.ZipFile(strut.fmu(name, folder="fmus")) as archive:
            assert any(it.startswith("binaries/") for it in archive.namelist())
    assert strut.describe("quanser-lqr")["components"]["rig"] == "QuanserQuarterCar"


def test_a_simulation_is_that_of_the_fmu_in_fmpy():
    time = np.linspace(0.0, 1.0, 1001)
    road = 0.02 * np.sin(2 * np.pi * 3 * time) ** 2
    ours = strut.simulate(
        "TumQuarterVehicle", {"strut.stiffness": 9000}, inputs={"time": time, "road.position": road}, step_size=1e-3
    )
    path = strut.fmu("TumQuarterVehicle", {"strut.stiffness": 9000})
    signal = np.array(list(zip(time, road)), dtype=[("time", float), ("road.position", float)])
    theirs = fmpy.simulate_fmu(
        path, stop_time=1.0, step_size=1e-3, output_interval=1e-3, input=signal, output=["suspension.deflection"]
    )
    assert np.ptp(ours["suspension.deflection"]) > 1e-3
    difference = ours["suspension.deflection"].to_numpy() - theirs["suspension.deflection"]
    assert np.abs(difference).max() < 1e-6 * np.ptp(theirs["suspension.deflection"])


def test_without_inputs_the_default_experiment_moves_the_model():
    motion = strut.simulate("TumQuarterVehicle")
    assert motion.index.name == "time" and np.ptp(motion["suspension.deflection"]) > 1e-3
    assert motion.attrs["units"]["suspension.deflection"] == "m"


@pytest.mark.parametrize("frame", [dict, pd.DataFrame, polars.DataFrame])
def test_inputs_come_as_a_mapping_or_a_frame(frame):
    inputs = frame({"time [s]": [0.0, 0.1, 0.5], "road.position [m]": [0.0, 0.01, 0.01]})
    motion = strut.simulate("QuarterCar", inputs=inputs)
    assert motion.index[-1] == pytest.approx(0.5) and motion["road.position"].iloc[-1] == 0.01


@pytest.mark.parametrize(
    ("call", "part"),
    [
        (lambda: strut.fmu("TumQuarterVehicel"), "did you mean `TumQuarterVehicle`"),
        (lambda: strut.fmu("TumQuarterVehicle", {"strut.stifness": 1.0}), "did you mean `strut.stiffness`"),
        (lambda: strut.fmu("TumQuarterVehicle", {"strut.stiffness": -1.0}), "strut.stiffness"),
        (lambda: strut.fmu("TumQuarterVehicle", {"strut.stiffness": 9e3}, name="a rig"), "identifier"),
        (lambda: strut.simulate("QuarterCar", inputs={"time": [0, 1], "rode": [0, 1]}), "no input `rode`"),
        (lambda: strut.simulate("QuarterCar", inputs={"time": [1, 0], "road.position": [0, 1]}), "have to rise"),
        (lambda: strut.simulate("QuarterCar", inputs={"road.position": [0, 1]}), "no column `time`"),
        (lambda: strut.simulate("QuarterCar", inputs={"time": [0, 1], "road.position [mm]": [0, 1]}), "in m"),
        (lambda: strut.simulate("QuarterCar", step_size=0.0), "leads nowhere"),
        (lambda: strut.check("nowhere.fmu"), "nowhere.fmu"),
    ],
)
def test_mistakes_are_told_in_words(call, part, tmp_path):
    with pytest.raises(ValueError, match=part):
        call()
    assert not list(tmp_path.iterdir())


def test_a_damaged_fmu_is_found_out():
    path = strut.fmu("LinearMotor")
    assert strut.check(path).problems == 0
    with zipfile.ZipFile(path) as archive, zipfile.ZipFile("broken.fmu", "w") as broken:
        for name in archive.namelist():
            text = archive.read(name)
            if name == "modelDescription.xml":
                text = text.replace(b'causality="output"', b'causality="outpt"', 1)
            broken.writestr(name, text)
    report = strut.check("broken.fmu", run=False)
    assert report.problems > 0 and "outpt" in str(report)


def test_the_examples_in_the_docstrings_run(examples):
    assert examples(strut) + examples(_models) + examples(_check) >= 10
