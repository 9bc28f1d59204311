"""CasADi's DaeBuilder on every FMU: it evaluates each, and its Jacobians are those of differences.

    python casadi_jacobians.py FOLDER
"""

import sys
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import casadi as ca
import numpy as np
from excitation import AMPLITUDE, excitation

# Of differences of fourth order, in shares of each function's size.
TOLERANCE = 1e-9


def jacobians(path):
    """How far the exact Jacobian is from differences, and how many of its entries are not zero."""
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        root = ElementTree.parse(Path(folder) / "modelDescription.xml").getroot()
        # In FMI 3.0 a variable is its type's element itself.
        declared = {v.get("name"): v[0] if v.tag == "ScalarVariable" else v for v in root.find("ModelVariables")}
        numbers = {name: kind for name, kind in declared.items() if kind.tag in ("Real", "Float64")}
        start = {name: float(kind.get("start") or 0.0) for name, kind in numbers.items() if not len(kind)}
        model = ca.DaeBuilder("fmu", folder)
        states, inputs = model.x(), model.u()
        functions = (["ode"] if states else []) + (["y"] if model.y() else [])
        function = model.create("function", ["x", "u"], functions)
        if not states and not inputs:
            # CasADi 3.8.2 crashes on a Jacobian of no columns.
            assert np.isfinite(np.array(function([], []))).all()
            return 0.0, 0
        # Off the rest position, where kinks lie.
        size = np.array([float(declared[name].get("nominal") or 1.0) for name in states])
        unit = [declared[name].get("unit") for name in inputs]
        x = np.array([start[name] for name in states]) + 0.01 * size * np.sin(1.0 + np.arange(len(states)))
        u = np.array([start[name] + excitation(name, of, 0.0123) for name, of in zip(inputs, unit)])
        sizes = np.concatenate([size, [AMPLITUDE[of or "1"] for of in unit]])
        point = np.concatenate([x, u])

        def values(point):
            found = function(point[: len(x)], point[len(x) :])
            return np.concatenate([np.array(part).ravel() for part in (found if len(functions) > 1 else [found])])

        names = [f"jac:{of}:{by}" for of in functions for by in ("x", "u")]
        blocks = [np.array(block) for block in function.factory("jacobian", ["x", "u"], names).call([x, u])]
        exact = np.vstack([np.hstack(blocks[i : i + 2]) for i in range(0, len(blocks), 2)]) * sizes
        rows = np.maximum(np.maximum(np.abs(values(point)), np.abs(exact).max(axis=1, initial=0.0)), 1e-12)
        worst = 0.0
        for column, amount in enumerate(sizes):
            direction = np.zeros(len(point))
            direction[column] = amount

            def difference(share, direction=direction):
                return (values(point + share * direction) - values(point - share * direction)) / (2.0 * share)

            # A long step is nearer where the function is straight, a short one where it bends.
            apart = [
                np.max(np.abs((4.0 * difference(share / 2.0) - difference(share)) / 3.0 - exact[:, column]) / rows)
                for share in (1e-3, 1e-4, 1e-5)
            ]
            worst = max(worst, min(apart))
        return worst, np.count_nonzero(exact)


def main():
    paths, entries = sorted(Path(sys.argv[1]).glob("*.fmu")), 0
    assert paths, "no FMUs"
    for path in paths:
        if path.parent.name == "fmi3" and "<Start " in zipfile.ZipFile(path).read("modelDescription.xml").decode():
            # CasADi 3.8.2 reads no variables of type String in FMI 3.0: "Cannot handle: Start".
            print(f"{path.stem}: not read, it has strings")
            continue
        worst, found = jacobians(path)
        print(f"{path.stem}: {found} entries, {worst:.1e} apart")
        assert worst <= TOLERANCE, path.stem
        entries += found
    assert entries > 1000, entries


if __name__ == "__main__":
    main()
