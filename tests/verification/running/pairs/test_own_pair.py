"""A pair by one option is the run with all of its values set by hand, to the last bit."""

import math

import pytest
from support.gearing.own_pair import write_pair
from support.housing import small_housing

import herringbone as hb
from herringbone.core import ParameterError
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.table_file import write_table
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.pair_values import pair_values
from herringbone.housing import write_housing

RUN = {"t_end": 1e-3, "fmu": "in-process"}
RADIAL, AXIAL = 6.34e8, {"pinion": 0.0, "wheel": 2.03e8}
"""Stiffness of the bearings as they are declared [N/m]."""
GEARS = ("pinion", "wheel")


def by_hand(file, folder, scope=""):
    """Values of all parts that a pair's file gives, as a user of `--set` works them out."""
    job = read_gear_file(file)
    pair, mesh = job.pair, job.mesh
    table = folder / "table.csv"
    write_table(stiffness_for(job), table)
    gear = {
        "stiffness_table": str(table),
        "base_helix_angle": math.asin(math.sin(pair.helix_angle) * math.cos(math.radians(20.0))),
        "face_width": 0.045,
        "mesh_damping_ratio": 0.08,
        "backlash": 120e-6,
        "coast_phase": pair_values(job)[0].coast_phase,  # tested by itself
    }
    bearing = {"pressure_angle": pair.working_transverse_pressure_angle}
    for i, name in enumerate(GEARS):
        body, shaft = pair.half_body[i], pair.gap_shaft[i]
        gear |= {
            f"{name}.number_of_teeth": pair.number_of_teeth[i],
            f"{name}.base_radius": pair.base_radius[i],
            f"{name}.mass": body.mass,
            f"{name}.inertia": body.inertia,
        }
        halves = {"y": (shaft.radial, body.mass), "z": (shaft.axial, body.mass)}
        for axis, (k, m) in {**halves, "t": (shaft.torsional, body.inertia)}.items():
            gear[f"{name}.shaft_stiffness_{axis}"] = k
            gear[f"{name}.shaft_damping_{axis}"] = 2.0 * 0.02 * math.sqrt(k * m / 2.0)
        for q, k in (("radial", RADIAL), ("axial", AXIAL[name])):
            bearing[f"{name}.{q}_damping"] = 2.0 * mesh.bearing_damping_ratio * math.sqrt(
                k * body.mass
            )  # fmt: skip
    parts = {"gear_mesh": gear, "bearing_supports": bearing}
    return {f"{scope}{p}.{name}": v for p, values in parts.items() for name, v in values.items()}


def equal(one, other):
    assert one.outcome.completed
    assert other.outcome.completed
    assert one.data.equals(other.data)
    moving = one.data[one.channel("bearing_force")].to_numpy()
    assert moving.std(axis=0).max() > 0.1


@pytest.mark.parametrize("pair", ["teeth", "helix", "module", "nearly spur"])
def test_pair_by_its_file_is_the_pair_by_hand(pair, tmp_path):
    file = write_pair(tmp_path / "own.toml", pair)
    values = by_hand(file, tmp_path)
    base = [values[f"gear_mesh.{gear}.base_radius"] for gear in GEARS]
    values["gear_mesh.wheel.tau"] = -200.0 * base[1] / base[0]
    own = hb.run("gearbox", gear=file, **RUN)
    equal(own, hb.run("gearbox", values=values, **RUN))
    shipped = hb.run("gearbox", **RUN)
    assert not own.data.equals(shipped.data)


def test_pair_and_housing_in_the_rig_are_those_by_hand(tmp_path):
    """The controller's ratio follows from the teeth; the housing is data in a folder."""
    file = write_pair(tmp_path / "own.toml", "teeth")
    write_housing(small_housing(), tmp_path / "box")
    own = hb.run("test_rig", gear=file, housing=tmp_path / "box", **RUN)
    values = by_hand(file, tmp_path, "gearbox.")
    values["bench_controller.gear_ratio"] = 57 / 23
    for name in ("modes", "shapes"):
        values[f"gearbox.modal_housing.{name}"] = str(tmp_path / "box" / f"{name}.csv")
    equal(own, hb.run("test_rig", values=values, **RUN))


# -- where it may be named, and what holds --------------------------------------------------------


def line(result, text):
    """The note that begins with a text."""
    (found,) = (note for note in result.info.notes if note.startswith(text))
    return found


def test_what_is_set_by_name_holds_over_the_pair_with_a_line(tmp_path):
    file = write_pair(tmp_path / "own.toml")
    values = {"gear_mesh.backlash": 2e-4, "bearing_supports.wheel.radial_damping": 3000.0}
    own = hb.run("gearbox", gear=file, values=values, **RUN)
    assert own.info.parameters["gear_mesh.backlash"] == 2e-4
    assert own.info.parameters["bearing_supports.wheel.radial_damping"] == 3000.0
    said = "set by name, kept over the pair's"
    kept = "gear_mesh.backlash = 0.0002"
    assert line(own, kept) == f"{kept}: {said} 0.00012"
    assert said in line(own, "bearing_supports.wheel.radial_damping = 3000.0")
    assert sum(said in note for note in own.info.notes) == len(values)
    by_name = by_hand(file, tmp_path) | values
    equal(own, hb.run("gearbox", values=by_name, **RUN))


def test_damping_at_bearings_follows_from_their_own_stiffness(tmp_path):
    """Stiffer bearings, the same ratio: the pair's file does not say how stiff they are."""
    file = write_pair(tmp_path / "own.toml")
    stiffer = {"bearing_supports.wheel.radial_stiffness": 4.0 * RADIAL}
    damping = [
        hb.run("gearbox", gear=file, values=values, **RUN).info.parameters[
            "bearing_supports.wheel.radial_damping"
        ]
        for values in ({}, stiffer)
    ]
    assert damping[1] == pytest.approx(2.0 * damping[0], rel=1e-14)


SYSTEM = 'name = "mine"\n{}[parts.box]\nsystem = "gearbox"\n'
LOAD = '[set]\n"gear_mesh.pinion.tau" = 200.0\n"gear_mesh.der(angle)" = 104.7\n'


@pytest.fixture
def mine(tmp_path):
    """A folder with a system of one gearbox; what its file and its scene say before the rest."""

    def make(system="", scene=""):
        folder = tmp_path / "mine"
        (folder / "scenes").mkdir(parents=True, exist_ok=True)
        (folder / "system.toml").write_text(SYSTEM.format(system), encoding="utf-8")
        (folder / "scenes" / "loaded.toml").write_text(f"{scene}{LOAD}", encoding="utf-8")
        return folder

    return make


def teeth(result):
    return [result.info.parameters[f"box.gear_mesh.{gear}.number_of_teeth"] for gear in GEARS]


def test_pair_of_a_system_and_of_its_scene_lie_beside_the_file_that_names_them(
    mine, tmp_path, monkeypatch
):
    """The scene's holds over the system's, the caller's over both."""
    monkeypatch.chdir(tmp_path)
    folder = mine('gear = "of_system.toml"\n')
    write_pair(folder / "of_system.toml", "helix")
    write_pair(folder / "scenes" / "of_scene.toml", "teeth")
    write_pair(tmp_path / "here.toml", "nearly spur")
    assert teeth(hb.run(folder, **RUN)) == [27.0, 81.0]
    angle = "box.gear_mesh.base_helix_angle"
    wanted = read_gear_file(folder / "of_system.toml").pair.base_helix_angle
    assert hb.run(folder, **RUN).info.parameters[angle] == wanted
    mine('gear = "of_system.toml"\n', 'gear = "of_scene.toml"\n')
    assert teeth(hb.run(folder, **RUN)) == [23.0, 57.0]
    mine('gear = { "box.gear_mesh" = "of_system.toml" }\n', 'gear = { box = "of_scene.toml" }\n')
    assert teeth(hb.run(folder, **RUN)) == [23.0, 57.0]
    assert teeth(hb.run(folder, gear="here.toml", **RUN)) == [25.0, 70.0]


def test_housing_of_a_system_and_of_its_scene(mine, tmp_path, monkeypatch):
    """Both as the pair's: beside the file that names it, or in the working folder."""
    monkeypatch.chdir(tmp_path)
    folder = mine('housing = "one"\n')
    for name in (folder / "one", folder / "scenes" / "two", tmp_path / "three"):
        write_housing(small_housing(), name)
    modes = "box.modal_housing.modes"
    assert hb.run(folder, **RUN).info.resources[modes] == str(folder / "one" / "modes.csv")
    mine('housing = "one"\n', 'housing = { box = "two" }\n')
    found = hb.run(folder, **RUN).info.resources[modes]
    assert found == str(folder / "scenes" / "two" / "modes.csv")
    found = hb.run(folder, housing="three", **RUN).info.resources[modes]
    assert found == str(tmp_path / "three" / "modes.csv")
    set_ = {"modal_housing.modes": "three/modes.csv", "modal_housing.shapes": "three/shapes.csv"}
    set_here = hb.run(folder, values=set_, **RUN)
    assert set_here.info.resources[modes] == str(tmp_path / "three" / "modes.csv")


def test_job_of_python_is_a_file(tmp_path):
    file = write_pair(tmp_path / "own.toml")
    runs = [hb.run("gearbox", gear=gear, **RUN) for gear in (file, str(file), read_gear_file(file))]
    for run in runs[1:]:
        assert run.data.equals(runs[0].data)


def test_system_without_a_gear_pair(tmp_path):
    folder = tmp_path / "plain"
    folder.mkdir()
    text = '[parts.motor]\ncomponent = "drive_motor"\n'
    (folder / "system.toml").write_text(text, encoding="utf-8")
    with pytest.raises(ParameterError, match="plain has no gear pair"):
        hb.run(folder, gear=write_pair(tmp_path / "own.toml"), **RUN)
