"""Housings of strangers: what runs, what is refused, and what is kept where they fail."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest
from support.ended_early import ended_early

from herringbone.commands.main import main

STRANGER = Path(__file__).parents[2] / "fmus" / "strange_housing.py"


@pytest.fixture(scope="module")
def stranger(tmp_path_factory):
    """Builds hand-written FMUs; changes of the source as (old, new) pairs, class names differ."""

    def build(name="StrangeHousing", *changes):
        folder = tmp_path_factory.mktemp("fmu")
        text = STRANGER.read_text().replace("StrangeHousing", name)
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        script = folder / f"{name.lower()}.py"
        script.write_text(text)
        command = [sys.executable, "-m", "pythonfmu", "build", "-f", str(script), "-d", str(folder)]
        subprocess.run(command, check=True, capture_output=True)
        return folder / f"{name}.fmu"

    return build


@pytest.mark.usefixtures("without_pictures")
def test_foreign_housing_runs(tmp_path, capsys, stranger):
    file = stranger()
    arguments = ["run", "test_rig", "--t-end", "0.001", "--json", "-o", str(tmp_path)]
    assert main([*arguments, "--replace", f"modal_housing={file}"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["model"]["gearbox.modal_housing"] == str(file)
    notes = [note for note in summary["notes"] if "gearbox.modal_housing" in note]
    assert any("it is stepped over 0.04 s before the start" in note for note in notes)
    assert any("and 35 more between these parts: a unit is not declared" in note for note in notes)
    assert any("a body by trial steps; it cannot repeat a step" in note for note in notes)
    table = pd.read_csv(tmp_path / "results.csv", comment="#")
    assert table["gearbox.modal_housing.pinion_left.v_y"].abs().max() > 0.0


@pytest.mark.usefixtures("without_pictures")
def test_foreign_housing_is_tested(tmp_path, capsys, stranger):
    """One that feeds power into the vibration runs, with a note; the check fails."""
    assert main(["check", str(stranger("Fair")), "--as", "housing"]) == 0
    out = capsys.readouterr().out
    assert re.search(r"passivity +holds +no negative work", out)
    assert out.endswith("all tests hold\n")
    file = stranger("Active", ("DAMPING = 50.0, 1e9, 1e4", "DAMPING = 50.0, 1e9, -1e5"))
    assert main(["check", str(file), "--as", "housing"]) == 1
    assert re.search(r"passivity +FAILS +-[\d.]+ of the highest work", capsys.readouterr().out)
    arguments = ["run", "test_rig", "--t-end", "1e-4", "--json", "-o", str(tmp_path)]
    main([*arguments, "--replace", f"modal_housing={file}"])
    notes = json.loads(capsys.readouterr().out)["notes"]
    assert any(f"{file} breaks the contract of housings: passivity: -" in note for note in notes)


def test_foreign_housing_without_state_has_no_adaptive_step(refused, stranger):
    """With `--tolerance` alone its step is found by runs."""
    replace = f"--replace=modal_housing={stranger('NoState')}"
    line = refused("--algorithm=li:tolerance=1e-3", replace)
    assert "gearbox.modal_housing cannot save and restore its state" in line


def test_foreign_housing_has_no_reference(refused, stranger):
    line = refused("--reference", f"--replace=modal_housing={stranger('NoReference')}")
    assert "gearbox.modal_housing is a foreign FMU" in line
    assert "no monolithic reference" in line


def test_foreign_housing_with_a_missing_seat(refused, stranger):
    seats = '("pinion_left", "pinion_right", "wheel_left", "wheel_right")'
    file = stranger("ThreeSeats", (seats, '("pinion_left", "pinion_right", "wheel_left")'))
    line = refused(f"--replace=modal_housing={file}")
    lacking = "wheel_right.f_x, wheel_right.f_y, wheel_right.f_z and 6 more, of the 36 variables"
    assert f"gearbox.modal_housing: {file} lacks {lacking} by which test_rig joins" in line


FAILURES = {
    "Nan": ("return True", "self.pinion_left.s_y = float('nan'); return True", "diverged"),
    "Inf": ("return True", "self.pinion_left.v_y = float('inf'); return True", "diverged"),
    "Refuses": ("return True", "return False", "part_failed"),
    "Raises": ("return True", "raise ValueError('too far')", "part_failed"),
}


@pytest.mark.usefixtures("without_pictures")
@pytest.mark.parametrize("name", FAILURES)
def test_foreign_housing_fails_during_the_run(tmp_path, capsys, stranger, name):
    old, new, outcome = FAILURES[name]
    late = f"if current_time > 4e-4:\n            {new}\n        return True"
    file = stranger(f"Housing{name}", (old, late))
    line, table, summary = ended_early(
        tmp_path, capsys, f"--replace=modal_housing={file}", outcome=outcome, fmu="in-process"
    )
    assert summary["culprit"].startswith("gearbox.modal_housing")
    assert "gearbox.modal_housing" in line
    assert "at 0.0004" in line
    if name == "Raises":
        assert "too far" in line
    assert table["time"].iloc[-1] >= 3.8e-4
