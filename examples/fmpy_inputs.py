"""Model exchange in FMPy with inputs that move: a quarter car on a sine road, as FMPy does it alone and as here.

    python examples/fmpy_inputs.py fmus/QuarterCar.fmu

FMPy 0.3.32 sets the inputs of model exchange once in each internal step of its solver, and not where that asks for rates. The
inputs lag by a step. The instance from `with_inputs` sets its inputs with each new time. FMPy needs no change for that.
"""

import shutil
import sys

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description, simulate_fmu
from fmpy.simulation import Input


def with_inputs(folder, table):
    """Arguments of `simulate_fmu` for an unpacked FMU of FMI 2.0 and inputs as FMPy takes them (a structured array)."""
    description = read_model_description(folder)
    instance = instantiate_fmu(folder, description, "ModelExchange")
    inputs, set_time = Input(instance, description, table), instance.setTime

    def set_time_and_inputs(time):
        set_time(time)
        # What changes at events only is FMPy's own matter.
        inputs.apply(time, discrete=False)

    instance.setTime = set_time_and_inputs
    return {
        "filename": folder, "fmi_type": "ModelExchange", "input": table,
        "model_description": description, "fmu_instance": instance,
    }  # fmt: skip


def main():
    folder = extract(sys.argv[1])
    time, speed = np.arange(0.0, 1.0, 1e-3), 2 * np.pi * 3.0
    columns = {"time": time, "road.position": 0.01 * np.sin(speed * time), "road.velocity": 0.01 * speed * np.cos(speed * time),
               "actuator.force": 0.0 * time}  # fmt: skip
    table = np.array(list(zip(*columns.values())), dtype=[(name, float) for name in columns])
    outputs = [v.name for v in read_model_description(folder).modelVariables if v.causality == "output"]
    closely = {"relative_tolerance": 1e-8, "record_events": False, "output": outputs, "output_interval": 1e-3, "stop_time": 0.9}
    alone = simulate_fmu(folder, fmi_type="ModelExchange", input=table, **closely)
    arguments = with_inputs(folder, table)
    result = simulate_fmu(**arguments, **closely)
    arguments["fmu_instance"].freeInstance()
    shutil.rmtree(folder)
    for name in outputs:
        off = np.abs(alone[name] - result[name]).max() / np.abs(result[name]).max()
        print(f"{name}: what FMPy makes of it alone is {off:.0e} off")


if __name__ == "__main__":
    main()
