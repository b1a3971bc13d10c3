"""The command `sweep`: what it takes, refuses, writes and says."""

import json

import pandas as pd
import pytest

import herringbone as hb
from herringbone.commands.main import BAD_INPUT, main
from herringbone.core.declaring.units import R_MIN

GEARBOX = ["sweep", "gearbox", "--speed", "900:1000:2", "--torque", "150"]


def test_a_table_in_the_units_that_were_asked_for(tmp_path, capsys):
    folder = tmp_path / "out"
    varied = ["--set", "gear_mesh.symmetry_deviation=0,1e-6"]
    assert main([*GEARBOX, *varied, "-o", str(folder), "--parquet", "--json"]) == 0
    said = capsys.readouterr()
    assert json.loads(said.out)["outcomes"] == {"steady": 4}
    assert "4 points in 2 chains" in said.err
    table = pd.read_csv(folder / "table.csv")
    assert table["speed"].tolist() == [900.0, 1000.0] * 2
    assert table["gear_mesh.symmetry_deviation"].tolist() == [0.0, 0.0, 1e-6, 1e-6]
    units = pd.read_csv(folder / "units.csv").set_index("column")["unit"]
    assert (units["speed"], units["gear_mesh.symmetry_deviation"]) == ("r/min", "m")
    state = hb.steady("gearbox", speed=1000.0 / R_MIN, torque=150.0)
    assert table["radiated_power"][1] == pytest.approx(hb.radiated_power(state).level_db, abs=0.01)
    parquet = pd.read_parquet(folder / "table.parquet")
    assert parquet["bearing_force.rms"].tolist() == table["bearing_force.rms"].tolist()
    assert main([*GEARBOX, *varied, "-o", str(folder), "--parquet"]) == 0
    assert "4 points: all there, nothing to compute" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["sweep", "e_axle", "--speed", "1000"], "no part of e_axle declares a speed set point"),
        (["sweep", "gearbox"], "at least one parameter"),
        (
            ["sweep", "gearbox", "--gear", "m24.toml,m28.toml"],
            "--gear m24.toml,m28.toml: it takes one file; for a study over several call "
            "hb.steady(SYSTEM, gear=FILE) in a loop, in Python",
        ),
        ([*GEARBOX, "--known-within", "1.1"], "--known-within 1.1: of the parameters of --sens"),
        ([*GEARBOX, "--sensitivities", "--known-within", "0.9"], "it is a factor, at least 1"),
        (["sweep", "gearbox", "--speed", "1:2"], "START:STOP:COUNT"),
        (["sweep", "gearbox", "--set", "gear_mesh.nothing=1,2"], "no variable 'nothing'"),
        ([*GEARBOX, "--column", "*.pinion.phy"], "did you mean gear_mesh.pinion.phi"),
        ([*GEARBOX, "--column", "nosuch"], "no output matches 'nosuch'; groups of channels: bear"),
        ([*GEARBOX, "--t-end", "0.1"], "--transient"),
        ([*GEARBOX, "--algorithm", "li"], "--transient"),
        ([*GEARBOX, "--series"], "--transient"),
        ([*GEARBOX, "--study", "absent.toml"], "drop speed, torque"),
        ([*GEARBOX, "--workers", "0"], "workers = 0"),
        (["sweep", "test_rig", "--scene", "runup", "--speed", "500"], "cycle"),
    ],
)
def test_wrong_input_is_one_line(tmp_path, capsys, arguments, said):
    assert main([*arguments, "-o", str(tmp_path / "out")]) == BAD_INPUT
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert not (tmp_path / "out").exists()


def test_a_point_that_came_to_nothing_makes_an_exit_code(tmp_path, capsys):
    """Nothing holds teeth together without load."""
    arguments = ["sweep", "gearbox", "--speed", "1000", "--torque", "0,150", "-o", str(tmp_path)]
    (tmp_path / "tornado.bearing_force.png").touch()  # of an earlier study
    assert main([*arguments, "--json"]) == 1
    assert not list(tmp_path.glob("tornado.*"))
    assert json.loads(capsys.readouterr().out)["outcomes"] == {"steady": 1, "not_converged": 1}
