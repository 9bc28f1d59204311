"""A hidden friction is found from frames and files alike; what comes out is shown, plotted and written."""

import json
import os
import signal
import subprocess
import sys
import textwrap
import time

import fmpy
import pandas as pd
import polars
import pytest
from conftest import RIG

import strut
from strut import _diagnosis
from strut._frames import columns


def test_a_hidden_friction_is_found(result):
    assert result.verdict == "identified"
    effect = result.effects.iloc[0]
    assert (effect["effect"], effect["place"], effect["parameter"]) == ("Coulomb friction", "strut", "strut.coulomb.force")
    assert effect["low"] <= 60.0 <= effect["high"] and effect["value"] == pytest.approx(60.0, rel=0.02)
    assert result.account[_diagnosis.SHARES].sum(axis=1).to_numpy() == pytest.approx(1.0)
    assert (result.account["effects"] > 0.1).all()
    printed = repr(result.account)
    assert "..." not in printed and all(name in printed for name in ["error", *_diagnosis.SHARES])
    assert (result.fit["extended"] >= result.fit["starting"]).all()
    assert repr(result).startswith("IDENTIFIED")


def test_a_notebook_shows_the_page_and_a_figure(result):
    shown = result._repr_html_()
    assert shown.startswith("<iframe") and "&lt;h1&gt;" in shown and "<h1>" not in shown
    result.plot().savefig("account.png")
    assert os.path.getsize("account.png") > 10_000


def test_a_saved_result_is_a_report_and_an_fmu(result, tmp_path):
    folder = result.save(tmp_path / "report")
    names = {it.name for it in folder.iterdir()}
    assert names == {"report.html", "report.json", "extended.toml", "extended.ssv", "extended.fmu"}
    starts = {it.name: it.start for it in fmpy.read_model_description(folder / "extended.fmu").modelVariables}
    assert float(starts["strut.coulomb.force"]) == pytest.approx(60.0, rel=0.02)
    provenance = json.loads((folder / "report.json").read_text())["provenance"]
    assert provenance["version"] == strut.__version__
    assert [len(it["sha256"]) for it in provenance["records"]] == [64, 64]


def test_frames_and_files_are_the_same_records(records):
    train, test = records
    train.to_csv("train.csv", index=False)
    timed = test.set_index("time [s]").rename_axis("time")
    timed.columns = [title.partition(" [")[0] for title in timed.columns]
    timed.attrs["units"] = {title.partition(" [")[0]: title.partition(" [")[2].rstrip("]") for title in test.columns}
    fits = [
        strut.diagnose(one, two, RIG, time_limit=0.0, progress=False).fit
        for one, two in [(train, test), ("train.csv", polars.from_pandas(test)), ([train], timed)]
    ]
    for fit in fits[1:]:
        pd.testing.assert_frame_equal(fit, fits[0], rtol=1e-9)


def test_the_time_is_found_and_row_numbers_are_none(records):
    train, _ = records
    plain = dict(columns(train, "train"))["time [s]"]
    german = train.rename(columns={"time [s]": "Zeit [s]"})
    title, values = columns(german[german["Zeit [s]"] > 1.0], "train")[0]
    assert title == "Zeit [s]" and values[0] > 1.0
    stamps = pd.Timestamp("2026-11-30", tz="Europe/Berlin") + pd.to_timedelta(train["time [s]"], unit="s")
    for index in (pd.DatetimeIndex(stamps), pd.to_timedelta(train["time [s]"], unit="s")):
        title, values = columns(train.drop(columns="time [s]").set_index(index), "train")[0]
        assert title == "time [s]" and values == pytest.approx(plain - plain[0], abs=1e-6)
    with pytest.raises(ValueError, match="only counts rows"):
        columns(train.drop(columns="time [s]").drop(index=3), "train")


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"rig": "tum-quarter-vehicel"}, "tum-quarter-vehicle"),
        ({"rig": None}, "which rig"),
        ({"known": {"sprung_mas": (1.0, 0.1)}}, "sprung_mass"),
        ({"effects": ["99x"]}, "has the effects"),
        ({"stroke": -1.0}, "positive"),
        ({"train": "nowhere.csv"}, "nowhere.csv"),
        ({"train": {"time": [0.0, 1.0]}}, "no signal"),
    ],
)
def test_mistakes_are_told_in_words(records, change, part):
    given = {"train": records[0], "test": records[1], "rig": RIG, "progress": False} | change
    with pytest.raises(ValueError, match=part):
        strut.diagnose(**given)


def test_ctrl_c_is_heard_within_a_second(tmp_path):
    script = f"""
        import sys, time, strut
        records = strut.virtual_records({RIG!r}, {{"strut.coulomb.force": 60.0}})
        print("ready", flush=True)
        try:
            strut.diagnose(*records, {RIG!r}, progress=False)
        except KeyboardInterrupt:
            print("interrupted", flush=True)
    """
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(1.0)
    start = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert process.stdout.readline() == "interrupted\n"
    assert process.wait(timeout=10) == 0
    assert time.monotonic() - start < 1.0
    assert not list(tmp_path.iterdir())


def test_the_examples_in_the_docstrings_run(examples):
    assert examples(_diagnosis) >= 8
