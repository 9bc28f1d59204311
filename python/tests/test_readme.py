"""The README's lines of Python, as they stand there."""

import re
from pathlib import Path

import fmpy
import numpy as np
import pytest

import strut

README = Path(__file__).resolve().parents[2] / "README.md"
BLOCKS = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)


@pytest.mark.parametrize("block", BLOCKS, ids=["diagnosis", "fmpy"])
def test_the_lines_run_and_show_something(block, monkeypatch, capsys):
    plotted = []
    # It would open a browser.
    monkeypatch.setattr(fmpy, "plot_result", plotted.append)
    scope = {}
    exec(compile(block, str(README), "exec"), scope)
    if "diagnose" in block:
        assert scope["result"].verdict == "identified"
        assert "Coulomb friction in the strut" in capsys.readouterr().out
        assert Path("report/extended.fmu").is_file()
    else:
        (result,) = plotted
        moving = [name for name in result.dtype.names[1:] if np.ptp(result[name]) > 0.0]
        assert len(moving) > 5
        ours = strut.simulate("TumQuarterVehicle", {"strut.stiffness": 9000})
        assert np.ptp(ours["suspension.deflection"]) > 1e-3
