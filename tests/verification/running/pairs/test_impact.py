"""The meshing impact by the pair's file is that of `herringbone gear` at the run's own point."""

import math

import numpy as np
import pytest
from support.gearing.own_pair import write_pair

import herringbone as hb
from herringbone.core import ParameterError
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.load.impact import impact_at

RUN = {"t_end": 1e-3, "fmu": "in-process"}
SHARE = 0.02
SIDES = ("left", "right")


@pytest.fixture
def file(tmp_path):
    found = write_pair(tmp_path / "own.toml")
    text = found.read_text(encoding="utf-8")
    asked = text.replace("[mesh]\n", f"[mesh]\nimpact_share = {SHARE}\n")
    found.write_text(asked, encoding="utf-8")
    return found


def test_force_at_the_operating_point(file):
    run = hb.run("test_rig", gear=file, **RUN)
    job = read_gear_file(file)
    load = np.mean([run.data[f"gearbox.gear_mesh.mesh_{side}.force"][0] for side in SIDES])
    speed = run.data["gearbox.gear_mesh.pinion.w"][0]
    assert speed == pytest.approx(1000.0 * math.pi / 30.0, rel=1e-3)
    expected = SHARE * impact_at(job, stiffness_for(job), speed, load).force
    name = "gearbox.gear_mesh.impact_force"
    assert run.info.parameters[name] == pytest.approx(expected, rel=1e-6)
    assert any(note.startswith(f"{name} = ") for note in run.info.notes)


@pytest.mark.parametrize(
    ("torque", "speed", "driven"),
    [(200.0, 1000.0, 1), (-200.0, 1000.0, 0), (-200.0, -1000.0, 1), (200.0, -1000.0, 0)],
)
def test_tips_of_the_driven_gear_enter(file, torque, speed, driven):
    run = hb.run("test_rig", gear=file, torque=torque, speed=speed, **RUN)
    job = read_gear_file(file)
    load = np.mean([run.data[f"gearbox.gear_mesh.mesh_{side}.force"][0] for side in SIDES])
    speed = abs(run.data["gearbox.gear_mesh.pinion.w"][0])
    expected = SHARE * impact_at(job, stiffness_for(job), speed, abs(load), driven).force
    assert run.info.parameters["gearbox.gear_mesh.impact_force"] == pytest.approx(
        expected, rel=1e-6
    )


def test_set_by_name_holds(file):
    run = hb.run("test_rig", gear=file, values={"gear_mesh.impact_force": 7.0}, **RUN)
    assert run.info.parameters["gearbox.gear_mesh.impact_force"] == 7.0
    assert any("impact_force: set by name, kept over" in note for note in run.info.notes)


def test_none_from_rest(file):
    run = hb.run("test_rig", gear=file, start="rest", **RUN)
    assert run.info.parameters["gearbox.gear_mesh.impact_force"] == 0.0
    assert any("no impact is set: the start has no speed" in note for note in run.info.notes)


def test_a_share_above_one_is_refused(file):
    text = file.read_text(encoding="utf-8").replace(f"= {SHARE}", "= 2")
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ParameterError, match=r"\[mesh\] impact_share = 2 is more than 1"):
        hb.run("test_rig", gear=file, **RUN)
