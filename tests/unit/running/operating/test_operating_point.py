"""Speed and torque of a run: the set points that sweeps and steady states take."""

import math

import pytest

from herringbone.commands.main import main
from herringbone.core import ParameterError
from herringbone.running import api
from herringbone.running.loading import load_scene, load_system
from herringbone.running.operating.commanded import commanded, operated, with_known_values
from herringbone.running.prepared import Wishes
from herringbone.scenes import Ask, Operating, Scene
from herringbone.scenes.scene_text import scene_text

POINT = {"speed": 157.0, "torque": 350.0}


@pytest.mark.parametrize("name", ["test_rig", "gearbox"])
def test_a_run_takes_the_values_that_a_sweep_takes(name):
    system, folder = load_system(name)
    scene = load_scene(folder, None)
    wishes = Wishes(values={"gear_mesh.symmetry_deviation": 1e-6})
    known = with_known_values(system, scene, wishes)
    found = operated(name, None, wishes, **POINT).values
    assert found == {**wishes.values, **commanded(known, POINT)}
    assert len(found) == 3
    assert operated(name, None, wishes, None, None) is wishes


def test_what_an_operating_point_decides_on_is_not_given_besides():
    """By any ending of its name."""
    wishes = Wishes(values={"bench_controller.speed_factor": 1.45})
    with pytest.raises(ParameterError, match=r"speed decides on bench_controller\.speed_factor"):
        operated("test_rig", None, wishes, 157.0, None)
    assert len(operated("test_rig", None, wishes, None, 350.0).values) == 2
    with pytest.raises(ParameterError, match=r"torque = nan: it must be a finite number"):
        operated("gearbox", None, Wishes(), None, math.nan)
    with pytest.raises(ParameterError, match="constant"):
        operated("test_rig", "runup", Wishes(), 157.0, None)


def test_the_command_gives_them_in_its_own_units(monkeypatch, tmp_path, capsys):
    taken = {}

    def run(system, **asked):
        taken.update(asked)
        raise ParameterError(system)

    monkeypatch.setattr(api, "run", run)
    assert main(["run", "gearbox", "--speed=300", "--torque", "150", "-o", str(tmp_path)]) == 2
    assert taken["speed"] == pytest.approx(10.0 * math.pi, rel=1e-15)
    assert taken["torque"] == 150.0
    assert main(["run", "gearbox", "--plan", "--speed", "300"]) == 2
    assert "[operating]" in capsys.readouterr().err


@pytest.mark.parametrize(
    "option",
    ["--verify", "--reference", "--parquet", "--record-step=1e-4", "--fmu=python", "--no-probe"],
)
def test_a_planned_steady_state_takes_no_option_of_a_run(option, tmp_path, capsys, monkeypatch):
    """It is refused before anything is planned."""
    monkeypatch.setattr("herringbone.commands.run.planned.plan", pytest.fail)
    file = tmp_path / "asking.toml"
    file.write_text(scene_text(Scene("asking", asks=(Ask(("bearing force",)),))), encoding="utf-8")
    assert main(["run", "gearbox", "--scene", str(file), "--plan", option]) == 2
    name = option.partition("=")[0]
    why = "of a run over time; scene asking asks of steady states, so leave it out"
    assert capsys.readouterr().err == f"herringbone: {name}: {why}\n"


def test_a_planned_steady_state_is_drawn_unless_that_is_left_out(tmp_path, capsys):
    """Its files are overwritten as those of `steady`; a picture of another state does not stay."""
    still = {"gear_mesh.symmetry_deviation": 0.0}
    file, folder = tmp_path / "asking.toml", tmp_path / "found"
    asks = (Ask(("bearing force",), tolerance=0.1),)
    scene = Scene("asking", values=still, asks=asks, operating=Operating(speed=(136.0, 136.0)))
    file.write_text(scene_text(scene), encoding="utf-8")
    command = ["run", "test_rig", "--scene", str(file), "--plan", "-o", str(folder)]
    assert main(command) == 0
    assert (folder / "steady.png").is_file()
    assert main([*command, "--overwrite", "--no-pictures"]) == 0
    assert sorted(f.name for f in folder.iterdir()) == ["orders.csv", "steady.json"]
    assert "steady.png" not in capsys.readouterr().out.rpartition("Steady state")[2]
