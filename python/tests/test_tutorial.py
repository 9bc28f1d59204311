"""The commands of the tutorial, as they stand there."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import matplotlib
import pytest

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "tutorial.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)


def test_the_lines_of_python_run_one_after_the_other(capsys):
    matplotlib.use("Agg")
    scope, printed = {}, []
    for block in blocks("python"):
        exec(compile(block, "tutorial.md", "exec"), scope)
        printed.append(capsys.readouterr().out)
    stated = [line.split("# ", 1)[1] for line in PAGE.splitlines() if line.startswith("print(") and "# " in line]
    assert stated == ["StiffRig.fmu", "0", "identified"]
    said = "\n".join(printed)
    for text in stated:
        assert re.search(rf"^{re.escape(text)}$", said, re.MULTILINE), text
    assert "Coulomb friction in the strut" in said
    # What it says of the last step.
    assert "body.acceleration" in printed[-1] and "Coulomb" not in printed[-1]
    for name in ["step.png", "account.png", "report/report.html", "report/report.json", "report/extended.fmu"]:
        assert Path(name).is_file(), name
    low, high = scope["result"].effects.query("parameter == 'strut.coulomb.force'")[["low", "high"]].iloc[0]
    assert low < 60.0 < high


@pytest.mark.parametrize("block", blocks("sh"))
def test_the_lines_of_the_terminal_run(block):
    for line in block.strip().splitlines():
        program, *arguments = shlex.split(line)
        assert program == "strut"
        subprocess.run([sys.executable, "-m", "strut", *arguments], check=True)
    assert '"verdict": "identified"' in Path("report/report.json").read_text(encoding="utf-8")
