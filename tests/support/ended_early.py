"""Runs of the command line that end early."""

import json

import pandas as pd

from herringbone.commands.main import main


def ended_early(folder, capsys, *arguments, outcome, fmu):
    """A run that ends early: the line, the kept table and the summary."""
    assert main(["run", "test_rig", "--fmu", fmu, "-o", str(folder), *arguments]) == 1
    err = capsys.readouterr().err
    assert len(err.splitlines()) == 1
    assert err.startswith(f"herringbone: {outcome}: ")
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["outcome"] == outcome
    table = pd.read_csv(folder / "results.csv", comment="#")
    assert table.notna().all(axis=None)
    assert table["time"].iloc[-1] <= summary["t_reached"] < summary["t_end"]
    return err, table, summary
