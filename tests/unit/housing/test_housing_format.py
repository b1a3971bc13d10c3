"""The format "modal-housing 1.0": exact round trip, and the message for each kind of bad data."""

import json
import re
import shutil
import zipfile
from dataclasses import fields, replace
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
from support.housing import small_housing

from herringbone.components.modal_housing import MODAL_HOUSING
from herringbone.core import Instance, ResourceError
from herringbone.housing import default_housing, read_housing, write_housing
from herringbone.housing.files.file_format import digest
from herringbone.housing.files.plausibility import implausible
from herringbone.housing.files.validation import housing_warnings


def assert_equal(first, second):
    for field in fields(first):
        a, b = getattr(first, field.name), getattr(second, field.name)
        if isinstance(a, np.ndarray):
            np.testing.assert_array_equal(a, b)
        else:
            assert a == b, field.name


@pytest.mark.parametrize("name", ["housing", "housing.zip"])
def test_round_trip_is_exact(tmp_path, name):
    housing = small_housing()
    write_housing(housing, tmp_path / name)
    assert_equal(read_housing(tmp_path / name), housing)
    assert [file.name for file in tmp_path.iterdir()] == [name]


def test_parts_that_are_absent_are_removed(tmp_path):
    write_housing(small_housing(), tmp_path)
    (tmp_path / "notes.txt").write_text("mine")
    housing = small_housing(seed=4, static=None, residual=None, gram=None)
    write_housing(housing, tmp_path)
    assert_equal(read_housing(tmp_path), housing)
    names = {"housing.json", "modes.csv", "shapes.csv", "notes.txt"}
    assert {file.name for file in tmp_path.iterdir()} == names


def test_the_component_reads_what_is_written(tmp_path):
    """Same static deflection from the FMU's own reader as from the model."""
    housing = small_housing()
    write_housing(housing, tmp_path)
    part = Instance(MODAL_HOUSING, "housing")
    part.set("modes", str(tmp_path / "modes.csv"))
    part.set("shapes", str(tmp_path / "shapes.csv"))
    part.set("start.wheel_left.f_y", 1000.0)
    part.initialise()
    expected = 1000.0 * housing.static_compliance()[2, 7]
    assert part["pinion_left.s_z"] == pytest.approx(expected, rel=1e-12)


def test_default_housing_is_what_the_component_has():
    housing = default_housing()
    part = Instance(MODAL_HOUSING, "housing")
    part.set("start.pinion_left.f_x", 1000.0)
    part.initialise()
    assert part["pinion_left.s_x"] == pytest.approx(
        1000.0 * housing.static_compliance()[0, 0], rel=1e-12
    )
    assert housing.seats == ("pinion_left", "pinion_right", "wheel_left", "wheel_right")


def test_receptance_against_the_state_space():
    """(K - w**2 M + j w C)^-1 of the oscillators, by a linear solve."""
    housing = small_housing()
    w, w_mode = 2 * np.pi * 777.0, 2 * np.pi * housing.frequency_hz
    dynamic = np.diag(w_mode**2 - w**2 + 2j * housing.damping_ratio * w_mode * w)
    expected = housing.seat_shapes @ np.linalg.solve(dynamic, housing.seat_shapes.T)
    np.testing.assert_allclose(housing.receptance(np.array([777.0]))[0], expected, rtol=1e-12)


def refusal(action) -> str:
    with pytest.raises(ResourceError) as caught:
        action()
    assert "\n" not in str(caught.value)
    return str(caught.value)


def changed(name: str, index, value):
    array = getattr(small_housing(), name).copy()
    array[index] = value
    return {name: array}


def without_wheel_right():
    housing = small_housing()
    points = tuple(p for p in housing.points if p.name != "wheel_right")
    return {"points": points, "shapes": np.delete(housing.shapes, [9, 10, 11], axis=0)}


POINTS = small_housing().points
BAD_MODELS = [
    (changed("frequency_hz", 1, np.nan), "mode 2: frequency nan Hz must be positive and finite"),
    (changed("frequency_hz", 1, 0.0), "mode 2: frequency 0 Hz must be positive"),
    (changed("damping_ratio", 4, 0.0), "mode 5: damping ratio 0 must lie between 0 and 1"),
    (changed("damping_ratio", 4, 1.0), "mode 5: damping ratio 1 must lie between 0 and 1"),
    (changed("shapes", (4, 2), np.inf), "shape of mode 3 at pinion_right y is not finite"),
    ({"shapes": small_housing().shapes + 0j}, "the shapes are complex"),
    ({"kind": ("elastic",) * 20}, "mode 1: kind 'elastic' is none of normal, residual, rigid"),
    (without_wheel_right(), "missing: wheel_right x, wheel_right y, wheel_right z"),
    ({"points": (*POINTS, POINTS[0])}, "shapes are (13, 20); points and modes give (16, 20)"),
    ({"points": (*POINTS[:4], replace(POINTS[4], dofs=("n",)))}, "dof 'n' is none of x, y, z"),
    ({"points": (*POINTS[:4], replace(POINTS[4], role="ear"))}, "role 'ear' is none of"),
    ({"points": (*POINTS[:4], replace(POINTS[4], role="seat"))}, "point A is no seat; seats are"),
    ({"residual": -np.eye(12)}, "matrix 'residual' has the negative eigenvalue -1"),
    ({"static": np.tri(12)}, "matrix 'static' is not symmetric"),
    ({"static": np.eye(6)}, "matrix 'static' is (6, 6); it must be (12, 12)"),
    ({"gram": -np.eye(20)}, "matrix 'gram' has the negative eigenvalue -1"),
    ({"valid_to_hz": -1.0}, "valid_to_hz = -1 Hz must be positive"),
    ({"frame": replace(small_housing().frame, rotation=((1.0, 0, 0),) * 3)}, "orthonormal"),
]


@pytest.mark.parametrize(("change", "expected"), BAD_MODELS)
def test_a_bad_model_is_not_written(tmp_path, change, expected):
    path = tmp_path / "bad"
    text = refusal(lambda: write_housing(small_housing(**change), path))
    assert expected in text
    assert str(path) in text
    assert not path.exists()


@pytest.fixture
def folder(tmp_path):
    write_housing(small_housing(), tmp_path / "housing")
    return tmp_path / "housing"


BAD_HEADS = [
    ("version", "2.0", "version '2.0'; 'modal-housing', version '1.0' is read"),
    ("normalisation", "unscaled", "normalisation 'unscaled'; only mass-normalised shapes"),
    ("units", {"length": "mm", "mass": "t", "time": "s"}, "unit of length is 'mm'; it must be m"),
    ("points", None, "'points' is missing"),
    ("points", "four", "'points' = 'four' has the wrong type"),
    ("valid_to_hz", "high", "'valid_to_hz' = 'high' has the wrong type"),
    ("valid_to_hz", float("nan"), "'NaN' is not a finite number"),
    ("sha256", {}, "'sha256' lacks modes.csv"),
    ("certificate", [1], "'certificate' = [1] has the wrong type"),
    ("certificate", {"error_bound": "low"}, "error_bound = 'low'; it must be a number"),
    ("certificate", {"error_bound": 0.01}, "error_bound without band_hz"),
    ("frame", {"origin": "here"}, "'frame' needs origin (3 numbers) and rotation (3 x 3)"),
]


@pytest.mark.parametrize(("name", "value", "expected"), BAD_HEADS)
def test_bad_head(folder, name, value, expected):
    file = folder / "housing.json"
    head = json.loads(file.read_text())
    head[name] = value
    if value is None:
        del head[name]
    file.write_text(json.dumps(head))
    text = refusal(lambda: read_housing(folder))
    assert expected in text
    assert "housing.json" in text


def test_a_csv_that_was_edited_is_recognised(folder):
    modes = folder / "modes.csv"
    modes.write_text(modes.read_text().replace("normal", "rigid", 1))
    text = refusal(lambda: read_housing(folder))
    assert "modes.csv is not the file that housing.json describes" in text


def test_hash_ignores_line_ends(folder):
    modes = folder / "modes.csv"
    modes.write_bytes(modes.read_bytes().replace(b"\n", b"\r\n"))
    assert_equal(read_housing(folder), small_housing())


def edit(folder, name: str, old: str, new: str):
    """Change a CSV file together with its hash."""
    file, head = folder / name, json.loads((folder / "housing.json").read_text())
    assert old in file.read_text()
    file.write_text(file.read_text().replace(old, new, 1))
    head["sha256"][name] = digest(file.read_bytes())
    (folder / "housing.json").write_text(json.dumps(head))


BAD_FILES = [
    ("static.csv", "m/N", "mm/N", "static.csv: unit 'mm/N'; it must be m/N"),
    ("residual.csv", "pinion_left,y", "pinion_left,q", "residual.csv: rows and columns must be"),
    ("surface_gram.csv", "kg^-1.m2", "1", "surface_gram.csv: unit '1'; it must be kg^-1.m2"),
    ("surface_gram.csv", "mode,m1,m2", "mode,m2,m1", "surface_gram.csv: column 'm2' stands where"),
    ("surface_gram.csv", "\n2,", "\n3,", "surface_gram.csv: give rows in the order of mode 1, 2"),
    ("shapes.csv", "m1,m2", "m2,m1", "shapes.csv: column 'm2' stands where 'm1' must: give"),
    ("modes.csv", "\n2,", "\n3,", "modes.csv, mode 2 has the number 3; sort the modes"),
    ("shapes.csv", "A,z", "B,z", "shapes.csv: rows are missing for A z"),
    ("modes.csv", "20,residual", "20,residual,", "modes.csv, line 22: 5 fields, 4 expected"),
]


@pytest.mark.parametrize(("name", "old", "new", "expected"), BAD_FILES)
def test_bad_files(folder, name, old, new, expected):
    edit(folder, name, old, new)
    assert expected in refusal(lambda: read_housing(folder))


@pytest.mark.parametrize("name", ["housing.json", "shapes.csv", "static.csv"])
@pytest.mark.parametrize("zipped", [False, True])
def test_a_missing_file(folder, name, zipped):
    (folder / name).unlink()
    path = shutil.make_archive(str(folder), "zip", folder) if zipped else folder
    text = refusal(lambda: read_housing(path))
    assert "cannot read" in text
    assert name in text


def test_damaged_archives(folder):
    assert "there is no file" in refusal(lambda: read_housing(folder / "no"))
    assert "is not a folder or a readable zip file" in refusal(
        lambda: read_housing(folder / "modes.csv")
    )
    path = folder.with_suffix(".zip")
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        for file in folder.iterdir():
            archive.write(file, file.name)
    path.write_bytes(path.read_bytes().replace(b"frequency_hz", b"frequency_Hz", 1))
    assert "Bad CRC-32" in refusal(lambda: read_housing(path))


def test_warnings():
    housing = small_housing(residual=None)
    assert housing_warnings(housing) == []
    few = housing_warnings(replace(housing, valid_to_hz=3000.0))
    assert few[0].endswith("valid_to_hz = 3000 Hz asks for modes to 4500 Hz")
    whole = replace(housing, valid_to_hz=3000.0, certificate={"next_frequency_hz": None})
    assert len(housing_warnings(whole)) == len(few) - 1
    (scale,) = housing_warnings(replace(housing, shapes=1e-3 * housing.shapes))
    assert "differs from static.csv by -100 %" in scale
    (residual,) = housing_warnings(small_housing())
    assert "residual.csv is not read by the FMU" in residual


def test_folder_by_the_page_alone(tmp_path):
    """The page's JSON and first lines make modal data: a mass of 10 kg at each seat, held alone."""
    page = (Path(__file__).parents[3] / "docs" / "housings.md").read_text(encoding="utf-8")
    plain = json.loads(page.partition("```json\n")[2].partition("```")[0])
    units = {
        name: f"{head}\n" for name, head in re.findall(r"\| `(\w+\.csv)`.*?`(# units.*?)`", page)
    }
    (seat,) = plain["points"]
    places = {
        "pinion_right": (0.0, -0.127),
        "wheel_left": (0.2, 0.127),
        "wheel_right": (0.2, -0.127),
    }
    others = ({**seat, "name": name, "position": [x, 0.0, z]} for name, (x, z) in places.items())
    plain["points"] = [seat, *others]
    modes, rows = range(1, 13), [f"{p['name']},{axis}" for p in plain["points"] for axis in "xyz"]
    head = ",".join(f"m{mode}" for mode in modes)

    def diagonal(value, names):
        lines = (
            ",".join([n, *(str(value * (i == j)) for j in range(12))]) for i, n in enumerate(names)
        )
        return "\n".join(lines) + "\n"

    tables = {
        "modes.csv": "mode,kind,frequency_hz,damping_ratio\n"
        + "".join(f"{mode},normal,700,0.02\n" for mode in modes),
        "shapes.csv": f"point,dof,{head}\n" + diagonal(0.1**0.5, rows),
        "surface_gram.csv": f"mode,{head}\n" + diagonal(0.005, map(str, modes)),
    }
    for name, table in tables.items():
        (tmp_path / name).write_text(units[name] + table, encoding="utf-8")
    plain["sha256"] = {name: sha256((tmp_path / name).read_bytes()).hexdigest() for name in tables}
    (tmp_path / "housing.json").write_text(json.dumps(plain), encoding="utf-8")
    housing = read_housing(tmp_path)
    assert list(implausible(housing)) == []
    compliance = 1.0 / (10.0 * (2.0 * np.pi * 700.0) ** 2)
    np.testing.assert_allclose(housing.static_compliance(), compliance * np.eye(12), rtol=1e-12)
    assert housing.gram is not None
