"""Start values and derivatives of every FMU in PyFMI, in both versions of FMI. Run by the Python that has PyFMI.

    python pyfmi_checks.py FOLDER
"""

import os
import sys
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from excitation import AMPLITUDE, excitation
from pyfmi import load_fmu

# Of central differences, in shares of each function's size.
TOLERANCE = 1e-6
# Between two ways to the same derivatives.
ROUNDING = 1e-12


def numbers(path):
    """Name, causality, and attributes of each variable that is one real number."""
    with zipfile.ZipFile(path) as archive:
        variables = ElementTree.fromstring(archive.read("modelDescription.xml")).find("ModelVariables")
    for variable in variables:
        # In FMI 3.0 a variable is its type's element itself. PyFMI 2.21.0 reads no arrays.
        kind = variable[0] if variable.tag == "ScalarVariable" else variable
        if kind.tag in ("Real", "Float64") and kind.find("Dimension") is None:
            yield variable.get("name"), variable.get("causality"), kind


def start_values(path, model):
    """Parameters and inputs have their start values before initialization; how many."""
    starts = {name: float(kind.get("start")) for name, causality, kind in numbers(path) if causality in ("parameter", "input")}
    for name, start in starts.items():
        assert model.get(name)[0] == start, name
    return len(starts)


def dense(matrix, rows, columns):
    """PyFMI gives matrices without entries as flat arrays."""
    return np.asarray(matrix.todense() if hasattr(matrix, "todense") else matrix).reshape(len(rows), len(columns))


def directional_derivatives(path, model):
    """Directional derivatives are those of differences, and PyFMI's linear model agrees with them; of how many functions."""
    states, rates = list(model.get_states_list()), list(model.get_derivatives_list())
    inputs, outputs = list(model.get_input_list()), list(model.get_output_list())
    if not (rates or outputs) or not (states or inputs):
        return 0
    model.initialize()
    model.event_update()
    model.enter_continuous_time_mode()
    units = {name: kind.get("unit") or "1" for name, _, kind in numbers(path)}
    amplitudes = [0.1 * AMPLITUDE[units[name]] for name in inputs]
    size = np.array([*(0.01 * model.nominal_continuous_states), *amplitudes])
    # Off the rest position, where kinks lie.
    x = model.continuous_states + size[: len(states)] * np.sin(1.0 + np.arange(len(states)))
    u = np.ravel(model.get(inputs)) + [excitation(name, units[name], 0.0123) for name in inputs]
    point, direction = np.concatenate([x, u]), size * np.cos(2.0 + np.arange(len(size)))

    def values(point):
        model.continuous_states = point[: len(states)].copy()
        model.set(inputs, point[len(states) :])
        return np.ravel(model.get(rates + outputs))

    middle = values(point)
    knowns, functions = ([model.get_variable_valueref(name) for name in names] for names in (states + inputs, rates + outputs))
    exact = model.get_directional_derivative(knowns, functions, direction)
    a, b, c, d = model.get_state_space_representation()
    linear = np.block([
        [dense(a, rates, states), dense(b, rates, inputs)],
        [dense(c, outputs, states), dense(d, outputs, inputs)],
    ])  # fmt: skip
    scale = np.maximum(np.abs(middle), np.abs(linear * size).max(axis=1))
    scale[scale == 0.0] = 1.0
    assert (np.abs(linear @ direction - exact) <= ROUNDING * scale).all(), "the linear model has other derivatives"
    # A long step is nearer where the function is straight, a short one where it bends.
    differences = [
        (values(point + h * direction) - values(point - h * direction)) / (2.0 * h) for h in (1e-2, 1e-3, 1e-4)
    ]
    apart = np.abs(np.array(differences) - exact).min(axis=0) / scale
    assert apart.max() <= TOLERANCE, f"{(rates + outputs)[apart.argmax()]} is {apart.max():.1e} off"
    return len(functions)


def main():
    paths = sorted(Path(sys.argv[1]).resolve().rglob("*.fmu"))
    assert paths, "no FMUs"
    failures, starts, functions = [], 0, 0
    with tempfile.TemporaryDirectory() as folder:
        # PyFMI writes logs to where it is.
        os.chdir(folder)
        for path in paths:
            try:
                model = load_fmu(str(path), kind="ME")
                starts += start_values(path, model)
                functions += directional_derivatives(path, model)
            except Exception as error:
                failures.append(f"{path.parent.name}/{path.stem}: {error!r}")
        os.chdir("/")
    print(f"{len(paths)} FMUs: {starts} start values, derivatives of {functions} functions")
    if failures:
        sys.exit("\n".join(failures))


if __name__ == "__main__":
    main()
