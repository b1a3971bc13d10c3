"""What users leave out by hand: a line says the model error at the operating point, or why not."""

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from support.foreign.c_housing import c_housing_fmu

import herringbone as hb
from herringbone.analysis.leaner.form import Form
from herringbone.analysis.leaner.question import Question, apart, lines_of
from herringbone.commands.main import main
from herringbone.components.registry import component_for
from herringbone.core.declaring.roles import Role
from herringbone.housing import default_housing, write_housing
from herringbone.running.reporting.summary import summary_text
from herringbone.scenes import Ask, Model, Scene

_R_MIN = math.pi / 30.0
_STILL = {"gear_mesh.symmetry_deviation": 0.0}
_SEATS = "seat velocity"
_ASKING = Scene("asking", values=_STILL, asks=(Ask((_SEATS,), tolerance=0.05),))
_FULL = Path(component_for(Role.HOUSING).resources)


def _reduced(full: Path, folder: Path) -> Path:
    assert main(["housing", "reduce", str(full), "--band", "800", "-o", str(folder)]) == 0
    return folder


def _warning(notes: tuple[str, ...]) -> str:
    (found,) = [note for note in notes if "model error" in note]
    return found


def _said(warning: str) -> float:
    found = re.search(rf"([0-9.]+) % of the spectrum of {_SEATS}", warning)
    assert found, warning
    return float(found[1]) / 100.0


def _truth(speed: float, **lean) -> float:
    values = {**_STILL, **lean.pop("values", {})}
    theirs = hb.steady("test_rig", speed=speed, tolerance=1e-4, values=_STILL)
    ours = hb.steady("test_rig", speed=speed, tolerance=1e-4, values=values, **lean)
    question = Question("seats", tuple(theirs.channels["seat_velocity"]), Form.SPECTRUM, 0.05)
    return apart(question, lines_of(ours, question), lines_of(theirs, question)).error


def test_a_housing_of_800_hz_is_warned_of_with_its_error_at_this_speed(tmp_path, capsys):
    housing = _reduced(_FULL, tmp_path / "h800")
    capsys.readouterr()
    said = []
    for speed in (1000.0 * _R_MIN, 2000.0 * _R_MIN):
        found = hb.run(
            "test_rig", scene=_ASKING, housing=housing, speed=speed, t_end=1e-3, fmu="in-process"
        )
        warning = _warning(found.info.notes)
        assert warning.startswith("warning: housing")
        assert "reduced to 800 Hz" in warning
        said.append(_said(warning))
        (row,) = (row for row in found.budget if row.source == "model left out")
        assert row.quantity == f"spectrum of {_SEATS}"
        assert row.value == pytest.approx(said[-1], rel=0.01)
        assert "800 Hz" in row.how
        assert said[-1] == pytest.approx(_truth(speed, housing=housing), rel=0.01)
    assert min(said) > 0.5  # core of the matter: the largest line of the rig is beyond 800 Hz
    steady = hb.steady("test_rig", scene=_ASKING, housing=housing, speed=1000.0 * _R_MIN)
    assert _said(_warning(steady.notes)) == pytest.approx(said[0], rel=0.01)


def test_bearings_on_ground_by_hand_are_warned_of_with_their_error():
    values = {"bearing_supports.seat_motion": 0.0}
    found = hb.run("test_rig", scene=_ASKING, values=values, t_end=1e-3, fmu="in-process")
    truth = _truth(1000.0 * _R_MIN, values=values)
    assert truth > 0.5
    assert _said(_warning(found.info.notes)) == pytest.approx(truth, rel=0.01)


def test_what_the_system_or_the_whole_data_have_is_no_warning():
    whole = hb.run("test_rig", scene=_ASKING, housing=_FULL, t_end=1e-3, fmu="in-process")
    assert not [note for note in whole.info.notes if "model error" in note]
    ground = hb.run("on_ground", t_end=1e-3, fmu="in-process")
    assert not [note for note in ground.info.notes if "model error" in note]
    assert not [row for run in (whole, ground) for row in run.budget if "left out" in row.source]


def test_of_a_run_up_the_budget_has_no_error_of_another_speed():
    """Its steady state is that of the last set points, 1000 r/min, which the run may never have."""
    scene = replace(
        _ASKING,
        start="rest",
        values={**_STILL, "bench_controller.cycle": "runup.csv"},
        model=Model(hold=("gearbox.modal_housing.q[9]", "gearbox.modal_housing.der(q[9])")),
    )
    found = hb.run("test_rig", scene=scene, fuse=True, t_end=2e-3)
    (row,) = (row for row in found.budget if row.source == "model left out")
    assert row.value is None
    assert row.how == (
        "leaner model of the scene: not known in a run whose set points of speed and torque change"
    )
    assert "steady at 1000 r/min" in _warning(found.info.notes)


def test_of_a_housing_fmu_the_budget_says_that_nobody_knows(tmp_path):
    file = c_housing_fmu(tmp_path)
    found = hb.run("gearbox", replace_parts={"modal_housing": file}, t_end=5e-3)
    (row,) = (row for row in found.budget if row.source == "model left out")
    assert row.value is None
    assert row.how == (
        "modal_housing, replaced by an FMU: not known at this operating point: modal_housing: "
        "nobody knows the equations"
    )
    assert f"{row.source} ({row.how})" in " ".join(summary_text(found).split())
    assert not _warning(found.info.notes).startswith("warning")


def test_an_error_that_nobody_can_know_is_told_as_unknown(tmp_path, capsys):
    model = default_housing()
    softer = replace(
        model, shapes=1.1 * model.shapes, static=None, residual=None, gram=None, certificate={}
    )
    write_housing(softer, tmp_path / "full")
    housing = _reduced(tmp_path / "full", tmp_path / "h800")
    capsys.readouterr()
    known = hb.steady("test_rig", scene=_ASKING, housing=housing)
    assert _said(_warning(known.notes)) > 0.05
    for file in (tmp_path / "full").iterdir():
        file.unlink()
    (tmp_path / "full").rmdir()
    warning = _warning(hb.steady("test_rig", scene=_ASKING, housing=housing).notes)
    assert "not known at this operating point" in warning
    assert "not there any more" in warning
