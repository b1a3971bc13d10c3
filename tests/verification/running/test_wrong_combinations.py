"""Tables, pairs, housings, ratios and angles that do not belong together: refused, or noted."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.gearing.gear_mesh import constant_table
from support.gearing.own_pair import write_pair
from support.housing import small_housing

import herringbone as hb
from herringbone.core import HerringboneError
from herringbone.core.places.paths import component_folder
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.table_file import write_table
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.stiffness import methods
from herringbone.housing import write_housing

STAGE = Path(__file__).parents[2] / "gear_stage.rexs"
DESIGN = component_folder("modal_housing") / "welded_housing.toml"
SHIPPED_TABLE = component_folder("gear_mesh") / "resources" / "mesh_stiffness.csv"
SHIPPED = "z 27/81, base radii 0.05029801/0.150894 m, base helix angle 0.4891167 rad, face width "
OWN = "z 23/57, base radii 0.04284645/0.1061847 m, base helix angle 0.4891167 rad, face width 0.045"
OTHER_DISTANCE = "other_distance.toml"
TABLE, RUN = "gear_mesh.stiffness_table", {"t_end": 3e-3, "fmu": "in-process"}


def jumping_table(file):
    """The shipped table with the stiffness of the left side ten times as large at phase 1/2."""
    lines = SHIPPED_TABLE.read_text(encoding="utf-8").splitlines()
    for n, line in enumerate(lines):
        head, _, stiffness = line.rpartition(",")
        if line.startswith("left,") and float(head.rpartition(",")[2]) == 0.5:
            lines[n] = f"{head},{10.0 * float(stiffness)!r}"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def turned_housing():
    """The wheel's seats 10 deg above x, at the same distance."""
    angle = np.radians(10.0)
    points = tuple(
        replace(p, position=(p.position[0] * np.cos(angle), p.position[0] * np.sin(angle),
                             p.position[2]))
        if p.role == "seat" else p
        for p in small_housing().points
    )  # fmt: skip
    return small_housing(points=points)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Files by name."""
    folder = tmp_path_factory.mktemp("files")
    own = write_pair(folder / "own.toml")
    write_pair(folder / OTHER_DISTANCE, "nearly spur")
    text = own.read_text(encoding="utf-8")
    single = text.replace("[gear_pair]", "[gear_pair]\nhalves = 1")
    (folder / "single.toml").write_text(single, encoding="utf-8")
    write_table(stiffness_for(read_gear_file(own)), folder / "own.csv")
    constant_table(folder / "unnamed.csv")
    write_housing(small_housing(), folder / "box")
    write_housing(small_housing(valid_to_hz=1000.0), folder / "low")
    write_housing(turned_housing(), folder / "turned")
    write_housing(
        replace(small_housing(static=None), shapes=1e-3 * small_housing().shapes), folder / "stiff"
    )
    jumping_table(folder / "jumping.csv")
    return folder


REFUSED = {
    "table of another pair": (
        lambda f: {"values": {TABLE: f / "own.csv"}},
        f"own.csv is the table of the pair {OWN} m; the parameters are of {SHIPPED}0.0473 m",
    ),
    "table kept over the pair's": (
        lambda f: {"gear": f / "own.toml", "values": {TABLE: SHIPPED_TABLE}},
        f"mesh_stiffness.csv is the table of the pair {SHIPPED}0.0473 m; the parameters are of "
        f"{OWN}",
    ),
    "teeth of another pair": (
        lambda f: {"values": {"gear_mesh.pinion.number_of_teeth": 26}},
        "teeth 26/81 do not fit base radii 0.05029801/0.150894 m (ratio 3.115385 against 3)",
    ),
    "face width of another table": (
        lambda f: {"values": {"gear_mesh.face_width": 0.04}},
        f"{SHIPPED}0.0473 m; the parameters are of {SHIPPED}0.04 m",
    ),
    "helix angle of another table": (
        lambda f: {"values": {"gear_mesh.base_helix_angle": 0.3}},
        "base helix angle 0.3 rad, face width 0.0473 m; set the table and the parameters of one",
    ),
    "torques that do not balance": (
        lambda f: {"values": {"gear_mesh.wheel.tau": -200.0}},
        "gear_mesh.pinion.tau = 200 N m is balanced by -600 N m at the wheel, gear_mesh.wheel.tau",
    ),
    "single helix": (
        lambda f: {"gear": f / "single.toml"},
        'single.toml": the pair has halves = 1; the component is double helical: halves = 2',
    ),
    "pair's file as housing": (
        lambda f: {"housing": f / "own.toml"},
        "modes, sensors: missing; gear_pair, mesh, table: unknown",
    ),
    "housing's dimensions as pair": (
        lambda f: {"gear": DESIGN},
        "welded_housing.toml: [description] is unknown; it takes gear_pair, modification, table",
    ),
    "stiffness table as pair": (
        lambda f: {"gear": f / "own.csv"},
        "own.csv: a gear file ends with one of .toml, .rexs, .xml",
    ),
    "modes without their shapes": (
        lambda f: {"values": {"modal_housing.modes": f / "box" / "modes.csv"}},
        "shapes.csv has 60 modes, the file of frequencies has 20",
    ),
    "flank of the pair alone": (
        lambda f: {"values": {"gear_mesh.flank": -1.0}},
        "the flank of gear_mesh or of its bearings is set by name, so that the other one was not",
    ),
}

NOTED = {
    "table that names no pair": (
        lambda f: {"values": {TABLE: f / "unnamed.csv"}},
        "gear_mesh: its stiffness table {f}/unnamed.csv does not tell of which pair it is",
    ),
    "angle of another pair": (
        lambda f: {"values": {"bearing_supports.pressure_angle": 0.349}},
        "modal_housing has its bearing seats 218.2 mm apart, gear_mesh a centre distance of "
        "214.1 mm, at the 20.00 deg of bearing_supports: housing, pair or angle belong",
    ),
    "ratio of another pair": (
        lambda f: {"system": "test_rig", "values": {"bench_controller.gear_ratio": 2.5}},
        "bench_controller has a gear ratio of 2.5, gearbox.gear_mesh 27/81 teeth, which is 3",
    ),
    "housing of another centre distance": (
        lambda f: {"gear": f / OTHER_DISTANCE},
        "modal_housing has its bearing seats 218.2 mm apart, gear_mesh a centre distance of "
        "191.3 mm",
    ),
    "housing of another direction": (
        lambda f: {"housing": f / "turned"},
        "modal_housing has the seats of the wheel 10.0 deg from x, as seen from those of the",
    ),
    "housing's band below the third harmonic": (
        lambda f: {"housing": f / "low"},
        "modal_housing: its data are valid to 1000 Hz, the mesh frequency of gear_mesh is 450 Hz: "
        "2 of its harmonics are inside",
    ),
    "modes and shapes of two housings": (
        lambda f: {"values": {"modal_housing.modes": f / "low" / "modes.csv",
                              "modal_housing.shapes": f / "box" / "shapes.csv"}},
        "modal_housing has its modes of {f}/low/modes.csv and its shapes of {f}/box/shapes.csv: of",
    ),
    "housing of another unit": (
        lambda f: {"housing": f / "stiff"},
        "modal_housing: the static stiffness at the seats is ",
    ),
    "table with a slip of the pen": (
        lambda f: {"values": {TABLE: f / "jumping.csv"}},
        "gear_mesh: the stiffness of the left mesh jumps from ",
    ),
    "load above the table": (
        lambda f: {"values": {"gear_mesh.pinion.tau": 6000.0}},
        "gear_mesh: the left mesh carries up to 6.9",
    ),
    "coast load above the table": (
        lambda f: {"values": {"gear_mesh.pinion.tau": -6000.0}},
        "gear_mesh: the left mesh carries up to 6.9",
    ),
    "flank of the bearings alone": (
        lambda f: {"values": {"bearing_supports.flank": -1.0}},
        "gear_mesh has y along the line of action of its drive flank (1), bearing_supports along "
        "that of the coast flank (-1)",
    ),
    "bearings in N/mm": (  # 200 N m / (2 base radii) / 6.34e5 N/m = 3.136 mm
        lambda f: {"values": {"bearing_supports.pinion.radial_stiffness": 6.34e5}},
        "gear_mesh.pinion_right.s_y comes to 3.14 mm, at a base radius of 50.3 mm",
    ),
    "records that fold the third harmonic": (  # 8 x 450 Hz need 1 / 7200 s
        lambda f: {"record_step": 5e-4, "t_end": 2e-2, "fuse": True},
        "records every 0.0005 s tell frequencies up to 1000 Hz: mesh harmonics of gear_mesh from "
        "3 on, 1350 Hz, show folded below, in lines, spectra and radiated power; "
        "record_step=0.0001 shows the first 8",
    ),
    "stage of REXS": (
        lambda f: {"gear": STAGE},
        f"{STAGE}: a REXS stage has one face width, 50 mm; it is taken as that of each half",
    ),
}  # fmt: skip


def run(asked):
    asked = {**({} if asked.get("fuse") else {"fmu": "in-process"}), "t_end": 3e-3, **asked}
    return hb.run(asked.pop("system", "gearbox"), **asked)


def test_shipped_systems_fit_together():
    for system in ("gearbox", "test_rig"):
        notes = hb.run(system, **RUN).info.notes
        said = "tolerance = 0.001 (default): li:degree=3", "inner steps: "
        assert [note for note in notes if not note.startswith(said)] == []


@pytest.mark.parametrize("wrong", REFUSED)
def test_refused(wrong, files):
    asked, said = REFUSED[wrong]
    with pytest.raises(HerringboneError) as caught:
        run(asked(files))
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("wrong", NOTED)
def test_noted(wrong, files, monkeypatch):
    """The stage's file names no method: its table by finite elements would take the longest."""
    monkeypatch.setattr(methods, "has_finite_elements", lambda: False)
    asked, said = NOTED[wrong]
    result = run(asked(files))
    assert result.outcome.completed
    said = said.format(f=files)
    (line,) = (note for note in result.info.notes if note.startswith(said))
    assert line in json.loads(result.to_json())["notes"]


def test_steady_states_and_sweeps_tell_a_housing_that_does_not_fit(files):
    """As a run does: the pair of another centre distance, whatever is computed of it; told once."""
    said, gear, told = "modal_housing has its bearing seats 218.2 mm apart", OTHER_DISTANCE, []
    state = hb.steady("gearbox", torque=200.0, gear=files / gear)
    hb.sweep("gearbox", torque=[200.0], gear=files / gear, told=told.append)
    for lines in (state.notes, told):
        assert len([line for line in lines if line.startswith(said)]) == 1
