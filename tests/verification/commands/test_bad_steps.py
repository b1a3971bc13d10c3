"""Steps that are too long: how the run ends, what is kept of it, what is told."""

import json
import re
from pathlib import Path

import pandas as pd
import pytest
from support.ended_early import ended_early

from herringbone.commands.main import main

KINDS = ("native", "python", "in-process")


@pytest.mark.parametrize("fmu", KINDS)
def test_step_beyond_the_limit(tmp_path, capsys, fmu):
    """Order 2 is unstable at 50 us; the values pass 1e30 after some hundred steps."""
    options = ("--step", "5e-5", "--algorithm", "jacobi:order=2")
    line, table, summary = ended_early(tmp_path, capsys, *options, outcome="diverged", fmu=fmu)
    how = "(grows beyond all bounds|is not finite)"
    assert re.search(f"{summary['culprit']} {how} at {summary['t_reached']:g} s", line)
    assert "use a step below 5e-05 s or an algorithm with a higher limit" in line
    assert len(table) > 100


UNSTABLE = ["run", "test_rig", "--t-end=0.005", "--step=1e-4", "--algorithm=jacobi"]
"""Twice the limit of order 2: ten orders of magnitude in 50 steps, but nothing overflows."""


def test_unstable_to_the_end(tmp_path, capsys):
    """The run is no success, though it reaches its end: all files, but no figures."""
    assert main([*UNSTABLE, "--fmu=in-process", "-o", str(tmp_path)]) == 1
    out, err = capsys.readouterr()
    assert len(err.splitlines()) == 1
    summary = json.loads((tmp_path / "summary.json").read_text())
    bond, time = summary["culprit"], summary["energy"]["time"]
    assert (summary["outcome"], summary["t_reached"]) == ("unstable", 0.005)
    assert bond.startswith("gearbox.bearing_supports.")
    assert err.startswith(
        f"herringbone: unstable: ran to the end, but the coupling is unstable from {time:.4g} s, "
        f"most of all at {bond}: use a step below 0.0001 s or an algorithm with a higher limit"
    )
    assert "Why unstable" in out
    assert "No figures" in out
    assert "Pinion speed" not in out
    assert out == (tmp_path / "summary.txt").read_text() + "\n"
    assert all(Path(file).is_file() for file in summary["results"])
    assert len(pd.read_csv(tmp_path / "results.csv", comment="#")) == 51


def test_results_are_written_before_the_diagnosis(tmp_path, monkeypatch):
    there = []

    def diagnose(*arguments):
        del arguments
        there.extend(sorted(file.name for file in tmp_path.iterdir()))

    monkeypatch.setattr("herringbone.running.prepared_runs.diagnose", diagnose)
    main([*UNSTABLE, "--fmu=in-process", "-o", str(tmp_path)])
    assert {"overview.png", "results.csv", "summary.json", "summary.txt"} <= set(there)


@pytest.mark.usefixtures("without_pictures")
def test_a_shortened_step_is_noted(tmp_path, capsys):
    command = ["run", "test_rig", "--t-end=1.5e-4", "--fmu=in-process", "--json"]
    main([*command, "--overwrite", "-o", str(tmp_path), "--step=4e-5"])
    summary = json.loads(capsys.readouterr().out)
    assert summary["communication_step"] == pytest.approx(3.75e-5)
    assert any("step = 4e-05 s: shortened to 3.75e-05 s" in note for note in summary["notes"])
    main([*command, "--overwrite", "-o", str(tmp_path), "--step=3.75e-5"])
    notes = json.loads(capsys.readouterr().out)["notes"]
    assert not any("shortened" in note for note in notes)
