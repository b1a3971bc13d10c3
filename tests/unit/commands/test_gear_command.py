"""The gear command: its table, its files, and what it refuses."""

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from herringbone.commands.gear.report import gear
from herringbone.commands.main import main
from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.components.resources.stiffness_table import read_stiffness_table
from herringbone.core.paths import component_folder
from herringbone.gears.stiffness import methods

THESIS = component_folder("gear_mesh") / "gear_pair.toml"
STAGE = Path(__file__).parents[2] / "gear_stage.rexs"
PLAIN = ["--method", "slices"]
"""The method is not what is tested, and the others take longer."""


def test_table_and_files(tmp_path, capsys):
    assert main(["gear", str(THESIS), *PLAIN, "-o", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    for line in ("transverse contact ratio", "1.4024", "12.6817 N/(mm um)", "normal, one half"):
        assert line in text
    (loads, left), (_, right) = read_stiffness_table(tmp_path / "mesh_stiffness.csv")
    assert left.shape == (10, 64)
    assert np.array_equal(left, right)
    assert loads[5] == pytest.approx(2252.228, abs=1e-3)
    assert (tmp_path / "gear_pair.png").stat().st_size > 10_000


def test_without_the_extra_coupled_slices_are_taken_and_said(tmp_path, capsys, monkeypatch):
    """The stage's file names no method: the best that is installed."""
    monkeypatch.setattr(methods, "has_finite_elements", lambda: False)
    assert main(["gear", str(STAGE), "-o", str(tmp_path), "--halves", "2"]) == 0
    said = capsys.readouterr()
    assert "table of z 27/51 is made by coupled slices, its mean within 4 %" in said.err
    assert "the extra 'fe' is missing: pip install 'herringbone[fe]'" in said.err
    assert "slices coupled over 1.15 (tooth)" in said.out
    header = (tmp_path / "mesh_stiffness.csv").read_text(encoding="utf-8").splitlines()[:6]
    assert "# Method: slice method, 60 slices coupled" in header[4]
    assert header[4].endswith("64 phases out of 256.")
    assert "mean 0.04, mesh harmonics 1 to 4 at most" in header[5]


def test_json_has_the_figures_of_the_table_in_si_units(tmp_path, capsys):
    assert main(["gear", str(THESIS), *PLAIN, "-o", str(tmp_path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["pair"]["transverse_contact_ratio"] == pytest.approx(1.4024, abs=5e-5)
    assert found["forces"]["normal"] == pytest.approx(2252.228, abs=1e-3)
    stiffness, at = found["mesh_stiffness"], 5
    assert stiffness["load"][at] == pytest.approx(found["forces"]["normal"], rel=1e-12)
    ratio = stiffness["load"][at] / stiffness["deflection"][at] / stiffness["secant"][at]
    assert ratio == pytest.approx(1.0, abs=1e-3)  # harmonics of 2 %: means of s and 1/s differ
    assert all(Path(file).is_file() for file in found["files"])


def test_component_values_are_those_of_the_component(tmp_path):
    """The gear_mesh component declares the values of its gear file, to the digits it gives."""
    gear(THESIS, tmp_path, method="slices")
    values = tomllib.loads((tmp_path / "gear_mesh.toml").read_text(encoding="utf-8"))["set"]
    assert len(values) == 15
    declared = {v.name: v.start for v in GEAR_MESH.declaration.variables}
    for name, value in values.items():
        assert declared[name.removeprefix("gear_mesh.")] == pytest.approx(value, rel=3e-4), name


def test_rexs_with_torque_and_halves(tmp_path):
    text = gear(STAGE, tmp_path, method="slices", torque=567.0, halves=2)
    assert "Forces at 567 N m" in text
    assert (tmp_path / "gear_mesh.toml").is_file()
    gear(STAGE, tmp_path / "single", method="slices")
    assert not (tmp_path / "single" / "gear_mesh.toml").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nothing.toml"], "cannot read nothing.toml"),
        (["pair.txt"], "a gear file ends with one of .toml, .rexs, .xml"),
        ([str(THESIS), "--method", "guess"], "method 'guess' is none of slices"),
        ([str(THESIS), "--torque", "-3"], "torque -3 N m must be positive"),
        ([str(THESIS), "--stage", "1"], "--stage is of REXS files only"),
        ([str(THESIS), "--halves", "2"], "--halves is of REXS files only"),
        ([str(STAGE), "--stage", "7"], "stage '7' is none of 10 (First stage)"),
        ([str(STAGE), "--halves", "3"], "halves = 3 must be 1"),
        ([str(THESIS), *PLAIN, "--torque", "5e9"], "too large"),
    ],
)
def test_bad_input(tmp_path, capsys, arguments, message):
    folder = tmp_path / "out"
    assert main(["gear", *arguments, "-o", str(folder)]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert not folder.exists()
