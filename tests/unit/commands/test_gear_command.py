"""The gear command: its table, its files, and what it refuses."""

import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from herringbone.commands.gear import report
from herringbone.commands.gear.report import gear
from herringbone.commands.main import main
from herringbone.components.resources.stiffness_table import read_stiffness_table
from herringbone.core.places.paths import component_folder
from herringbone.gears import job_stiffness
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.table_file import table_text
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.stiffness import methods

THESIS = component_folder("gear_mesh") / "gear_pair.toml"
STAGE = Path(__file__).parents[2] / "gear_stage.rexs"
PLAIN = ["--method", "slices"]
"""The method is not what is tested, and the others take longer."""


def test_table_and_files(tmp_path, capsys):
    assert main(["gear", str(THESIS), *PLAIN, "-o", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    for line in ("transverse contact ratio", "1.4024", "12.6817 N/(mm um)", "normal to the flank"):
        assert line in text
    assert re.search(r"normal backlash by geometry +0.0 um", text)
    assert re.search(r"normal backlash in runs +180.0 um \(\[mesh\] backlash\)", text)
    (loads, left), (_, right) = read_stiffness_table(tmp_path / "mesh_stiffness.csv")
    assert left.shape == (10, 64)
    assert np.array_equal(left, right)
    assert loads[5] == pytest.approx(2252.228, abs=1e-3)
    assert (tmp_path / "gear_pair.png").stat().st_size > 10_000


def test_without_the_extra_coupled_slices_are_taken_and_said(tmp_path, capsys, monkeypatch):
    """The stage's file names no method: the best that is installed."""
    monkeypatch.setattr(methods, "has_finite_elements", lambda: False)
    job_stiffness._tell_missing.cache_clear()  # it is said once for each pair in a process
    assert main(["gear", str(STAGE), "-o", str(tmp_path), "--halves", "2"]) == 0
    said = capsys.readouterr()
    assert "table of z 27/51 is made by coupled slices, its mean within 4 %" in said.err
    assert "the extra 'fe' is missing: pip install 'herringbone[fe]'" in said.err
    assert "slices coupled over 1.15 (tooth)" in said.out
    header = (tmp_path / "mesh_stiffness.csv").read_text(encoding="utf-8").splitlines()[:9]
    (method,) = (line for line in header if line.startswith("# Method: slice method, 60 slices"))
    assert method.endswith("64 phases out of 256.")
    (stated,) = (line for line in header if line.startswith("# uncertainty: "))
    mean, *_ = map(float, stated.split()[2:])
    assert mean == 0.04


def test_json_has_the_figures_of_the_table_in_si_units(tmp_path, capsys):
    assert main(["gear", str(THESIS), *PLAIN, "-o", str(tmp_path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["pair"]["transverse_contact_ratio"] == pytest.approx(1.4024, abs=5e-5)
    assert found["forces"]["half"]["normal"] == pytest.approx(2252.228, abs=1e-3)
    stiffness, at = found["mesh_stiffness"], 5
    assert stiffness["load"][at] == pytest.approx(found["forces"]["half"]["normal"], rel=1e-12)
    ratio = stiffness["load"][at] / stiffness["deflection"][at] / stiffness["secant"][at]
    assert ratio == pytest.approx(1.0, abs=1e-3)  # harmonics of 2 %: means of s and 1/s differ
    assert all(Path(file).is_file() for file in found["files"])
    assert found["notes"] == []


def test_json_has_the_notes(tmp_path):
    """Those that stand below the table."""
    notes = json.loads(gear(STAGE, tmp_path, method="slices", as_json=True))["notes"]
    assert notes == [
        f"{STAGE}: cylindrical_gear 'Wheel' has no material; material 'Steel' is taken"
    ]
    assert f"note: {notes[0]}" in gear(STAGE, tmp_path, method="slices").splitlines()


def test_rexs_with_torque_and_halves(tmp_path):
    text = gear(STAGE, tmp_path, method="slices", torque=567.0, halves=2)
    assert "Forces at 567 N m of the pinion (pair   one half)" in text
    assert text.endswith(f"In a gearbox: herringbone run SYSTEM --gear {STAGE}")
    assert "In a gearbox" not in gear(STAGE, tmp_path / "single", method="slices")


def test_stages_of_one_file_have_folders_of_their_own(tmp_path, monkeypatch):
    """And the command that takes the stage into a gearbox names it."""
    monkeypatch.chdir(tmp_path)
    text = gear(STAGE, method="slices", halves=2, stage="10")
    assert text.endswith(f"In a gearbox: herringbone run SYSTEM --gear {STAGE}#10")
    text = gear(STAGE, method="slices", halves=2, stage="First stage")
    assert text.endswith(f'--gear "{STAGE}#First stage"')
    folders = {path.name for path in (tmp_path / "results").iterdir()}
    assert folders == {"gear-gear_stage-10", "gear-gear_stage-First_stage"}


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
        ([str(THESIS), "--accuracy", "12"], "class 12 must be an integer from 1 to 11"),
        ([str(THESIS), "--speed", "0"], "speed 0 rad/s must be positive"),
        ([str(THESIS), "--symmetry-deviation", "20kg"], "unit 'kg' is no length"),
        ([str(THESIS), "--symmetry-deviation", "much"], "'much' is no length"),
        ([str(THESIS), "--pinion-axial-stiffness", "1"], "goes with --symmetry-deviation"),
        (
            [str(THESIS), "--symmetry-deviation", "1um", "--pinion-axial-stiffness", "stiff"],
            "give a number in N/m, or rigid",
        ),
        (
            [str(THESIS), "--symmetry-deviation", "1um", "--pinion-axial-stiffness", "-1"],
            "axial stiffness -1 N/m of the pinion",
        ),
        ([str(STAGE), "--symmetry-deviation", "1um"], "load sharing is of double-helical pairs"),
    ],
)
def test_bad_input(tmp_path, capsys, arguments, message):
    folder = tmp_path / "out"
    assert main(["gear", *arguments, "-o", str(folder)]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert not folder.exists()


@pytest.fixture
def thin(tmp_path):
    """Gear file of a small pair, of the method that is taken if none is given."""
    file = tmp_path / "thin.toml"
    file.write_text(
        "[gear_pair]\nnumber_of_teeth = [30, 40]\nnormal_module = '2 mm'\nface_width = '3 mm'\n"
        "halves = 1\n",
        encoding="utf-8",
    )
    return file


def test_table_is_that_of_the_method(thin, tmp_path):
    """The mesh that carries the load on the flanks is the one of the table."""
    text = gear(thin, tmp_path)
    job = read_gear_file(thin)
    torque = 100e3 * 3e-3 * 30 * 1e-3  # face width 3 mm, reference radius 30 mm
    assert (
        f"Forces at {torque:g} N m of the pinion: 100 N/mm of face width, as no torque is given"
    ) in text
    expected = table_text(stiffness_for(job))
    assert (tmp_path / "mesh_stiffness.csv").read_text(encoding="utf-8") == expected


def test_a_face_too_narrow_for_slices_is_refused_before_the_table(tmp_path, capsys, monkeypatch):
    """The meshing impact takes their calibration, whatever the method of the table."""
    monkeypatch.setattr(report, "stiffness_for", None)
    file = tmp_path / "narrow.toml"
    text = THESIS.read_text(encoding="utf-8")
    file.write_text(re.sub('face_width = ".*"', 'face_width = "6 mm"', text), encoding="utf-8")
    assert main(["gear", str(file), "--method", "fe", "-o", str(tmp_path / "out")]) == 2
    assert "[table.calibration] slices = 1.0" in capsys.readouterr().err


def test_loaded_pair(tmp_path, capsys):
    """Table, JSON, CSV and picture tell the same of a held pinion."""
    options = [
        "--symmetry-deviation", "10um", "--pinion-axial-stiffness", "1e8", "--speed", "1200",
        "--accuracy", "5", "--load-factor", "1.25", *PLAIN, "-o", str(tmp_path),
    ]  # fmt: skip
    assert main(["gear", str(THESIS), *options]) == 0
    text = capsys.readouterr().out
    for line in (
        "Under 200 N m of the pinion, f_A 10 um, pinion axially held by 1e+08 N/m; left   right",
        "at 1200 r/min, class 5, K_A 1.25",
        "subcritical",
        "place of this pressure on the path, from A",
    ):
        assert line in text
    assert main(["gear", str(THESIS), *options, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    loaded, force = found["loaded"], found["forces"]["pair"]["normal"]
    left, right = (np.array(half["force"]) for half in loaded["halves"])
    assert left + right == pytest.approx(np.full(left.size, force), rel=1e-8)
    assert f"{loaded['over_torque']['share_left'][4]:.4f}" in text
    assert loaded["over_torque"]["torque"][4] == pytest.approx(200.0)
    error = np.array(loaded["transmission_error"]["value"])
    assert loaded["transmission_error"]["peak_to_peak"] == pytest.approx(np.ptp(error))
    secant = np.array(loaded["halves"][0]["secant"])
    assert secant == pytest.approx(left / loaded["halves"][0]["deflection"])
    assert f"{1e-6 * secant.mean():.1f}" in text
    assert loaded["dynamic_factor"]["specific_load"] == pytest.approx(1.25 * 38.75e3, rel=1e-4)
    maps = pd.read_csv(tmp_path / "flank_load.csv", comment="#")
    said = (tmp_path / "flank_load.csv").read_text(encoding="utf-8").splitlines()[2]
    assert said.startswith("# line_load, pressure: means over strips of the flank")
    for side, flank in zip(("left", "right"), loaded["flank_load"], strict=True):
        half = maps[maps["side"] == side]
        assert half["pressure"].max() == pytest.approx(flank["largest_pressure"], rel=0.02)
        assert f"{1e-6 * flank['largest_pressure']:.0f}" in text
    assert maps["axial"].max() < 69.8e-3
    assert (tmp_path / "gear_load.png").stat().st_size > 10_000


def test_rigid_and_floating_pinion(tmp_path, capsys):
    """`rigid` is said, infinity is no JSON; without it the pinion floats."""
    for held, expected in ((["--pinion-axial-stiffness", "rigid"], "rigid"), ([], 0.0)):
        options = ["--symmetry-deviation", "20 um", *held, *PLAIN, "-o", str(tmp_path)]
        assert main(["gear", str(THESIS), *options, "--json"]) == 0
        found = json.loads(capsys.readouterr().out)["loaded"]
        assert found["symmetry"]["pinion_axial_stiffness"] == expected
        share = found["over_torque"]["share_left"][4]
        assert share == pytest.approx(1.0 if held else 0.5, abs=1e-6)


def test_gear_outside_the_standard_has_no_dynamic_factor(thin, tmp_path, capsys):
    """Faces below 4 mm have no ISO 1328-1 class: said in the table, refused if a class is asked."""
    assert main(["gear", str(thin), "-o", str(tmp_path)]) == 0
    assert "face width 3 mm is outside the scope of ISO 1328-1" in capsys.readouterr().out
    assert main(["gear", str(thin), "-o", str(tmp_path), "--accuracy", "7"]) == 2
    assert "face width 3 mm is outside the scope" in capsys.readouterr().err


def test_teeth_that_deviate_over_a_turn_of_the_wheel(tmp_path, capsys):
    """Cumulative pitches of both gears make most of the error; line loads rise by a multiple."""
    file = tmp_path / "pair.toml"
    file.write_text(THESIS.read_text(encoding="utf-8") + "[deviations]\ngrade = 6\nseed = 1\n")
    assert main(["gear", str(file), *PLAIN, "-o", str(tmp_path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    loaded = found["loaded"]
    teeth, ideal = loaded["deviating_teeth"], loaded["flank_load"][0]["largest_line_load"]
    error = np.array(teeth["transmission_error"])
    assert error.shape == (2, 4 * 81)
    job = read_gear_file(file)
    for half, curve in zip(job.deviations.of_halves(job.pair), error, strict=True):
        pitches = sum(np.ptp(gear.cumulative_pitch) for gear in half)
        assert np.ptp(curve) == pytest.approx(pitches, rel=0.3)
    assert min(teeth["largest_line_load"]) > 3.0 * ideal
    assert main(["gear", str(file), *PLAIN, "-o", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "Over a turn of the wheel, coupled slices: teeth deviate as ISO 1328-1 class 6" in said
