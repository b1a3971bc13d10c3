"""Gear files in TOML: what is read, and the message for each kind of bad one."""

import math
import re

import numpy as np
import pytest
from support.gearing.gears import THESIS, gear_pair

from herringbone.core import HerringboneError, ParameterError
from herringbone.core.places.paths import component_folder
from herringbone.gears.accuracy.deviation_file import write_deviations
from herringbone.gears.accuracy.deviations import deviations
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.job import GearJob
from herringbone.gears.pair_values import backlash_notes, pair_values

GOOD = """
[gear_pair]
number_of_teeth = [27, 81]
normal_module = "3.5 mm"
helix_angle = "30 deg"
face_width = 0.0473
groove_diameter = ["95 mm", 0.310]
[modification]
tip_relief = ["5 um", 0.0]
[table]
torque = "0.2 kN m"
corner_contact = true
method = "slices"
[table.calibration]
slices = 0.88
"""


@pytest.fixture
def message(tmp_path):
    """The message with which a changed gear file is refused."""

    def read(old: str, new: str) -> str:
        assert old in GOOD
        file = tmp_path / "bad.toml"
        file.write_text(GOOD.replace(old, new), encoding="utf-8")
        with pytest.raises(HerringboneError) as caught:
            read_gear_file(file)
        assert "\n" not in str(caught.value)
        return str(caught.value)

    return read


def test_one_relief_is_that_of_both_gears(tmp_path):
    file = tmp_path / "pair.toml"
    file.write_text(GOOD.replace('["5 um", 0.0]', '"12 um"'), encoding="utf-8")
    assert read_gear_file(file).modification.tip_relief == (12e-6, 12e-6)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("face_width = 0.0473", "face_width = 47.3", r"433 times .*write '47.3 mm'"),
        (
            "face_width = 0.0473",
            "face_width = '90 um'",
            "face_width = 90 um is 0.0257 times the normal module of 3.5 mm; write '90 mm' if",
        ),
        ("face_width = 0.0473", "face_width = 47.3e-6", "are in m: check its unit$"),
        ('["95 mm", 0.310]', "[95, 310]", "groove diameter 95000 mm must lie between"),
        ('["5 um", 0.0]', "[0, 5]", r"1.43e\+03 times .*write '5 um'"),
        ("[table]", "[mesh]\nbacklash = 180\n[table]", "write '180 um'"),
        ("[table]", "[mesh]\nbacklash = 0.3\n[table]", "85.7 times .*in m: write '0.3 mm' if"),
        (
            "[table]",
            "[mesh]\nbacklash = '300 mm'\n[table]",
            r"backlash = 300 mm is 85.7 times the normal module of 3.5 mm; write '300 um' if",
        ),
        ("[table]", "[mesh]\nbacklash = '3e9 m'\n[table]", "of 3.5 mm; check its unit$"),
        ("[modif", "density = 7.85\n[modif", "between 500 and 25000 kg/m3; write '7.85 g/cm3' if"),
        ("[modif", "density = 7.85e-9\n[modif", "write '7.85e-09 t/mm3' if that is meant"),
        ("[modif", "youngs_modulus = 206\n[modif", r"1e\+12 Pa; write '206 GPa' if that is meant"),
        ("[modif", "youngs_modulus = 2.06e5\n[modif", "write '206000 MPa' if that is meant"),
        ("[modif", "youngs_modulus = '2.06e9 MPa'\n[modif", r"= 2.06e\+15 Pa must .*1e\+12 Pa$"),
        ("[table]", "[mesh]\nbacklash = [0, 0]\n[table]", "must be one value"),
        ("[table]", "[table]\nloads = 5.0", "must be a list"),
        ("[table]", "[table]\nunread = 5.0", r"\[table\] unread is unknown"),
        (
            "number_of_teeth = [27, 81]",
            "number_of_teeth = 27",
            "be two numbers: pinion, wheel",
        ),
    ],
)
def test_lengths_without_their_unit_and_lists_out_of_place(message, old, new, said):
    """47.3 m over the pinion's 27 * 3.5 mm / cos 30 deg; 5 m over the module."""
    found = message(old, new)
    assert re.search(said, found), found
    assert "bad.toml: " in found


def test_auto_follows_from_the_other_values(tmp_path):
    """Without backlash at the centre distance, as the profile shifts follow from it."""
    file = tmp_path / "pair.toml"
    asked = 'center_distance = "220 mm"\nprofile_shift_coefficient = '
    with_distance = GOOD.replace("face_width", f'{asked}"auto"\nface_width')
    file.write_text(with_distance, encoding="utf-8")
    pair = read_gear_file(file).pair
    assert pair.center_distance == 0.22
    assert pair.profile_shift_coefficient[0] == pair.profile_shift_coefficient[1] > 0.0
    assert pair.normal_backlash == pytest.approx(0.0, abs=1e-12)
    file.write_text(with_distance.replace('"auto"', '[0.1, "auto"]'), encoding="utf-8")
    assert read_gear_file(file).pair.profile_shift_coefficient[0] == 0.1


def test_backlash_of_the_geometry_that_runs_do_not_take_is_told(tmp_path):
    """A wide center distance: teeth apart; a [mesh] backlash hides it."""
    file = tmp_path / "pair.toml"
    text = GOOD.replace("face_width", 'center_distance = "220 mm"\nface_width')
    file.write_text(text + '[mesh]\nbacklash = "180 um"\n', encoding="utf-8")
    job = read_gear_file(file)
    large, other = backlash_notes(job)
    assert f"{1e6 * job.pair.normal_backlash:.4g} um" in large
    assert "runs take [mesh] backlash = 180 um" in other
    assert pair_values(job)[1] == (large, other)
    file.write_text(GOOD + '[mesh]\nbacklash = "180 um"\n', encoding="utf-8")
    assert not backlash_notes(read_gear_file(file))


def test_units_become_si(tmp_path):
    file = tmp_path / "pair.toml"
    file.write_text(GOOD, encoding="utf-8")
    job = read_gear_file(file)
    assert job.pair.normal_module == 3.5e-3
    assert job.pair.helix_angle == math.radians(30.0)
    assert job.pair.groove_diameter == (0.095, 0.310)
    assert job.modification.tip_relief == (5e-6, 0.0)
    assert job.torque == 200.0
    assert job.task().corner_contact
    assert job.method == "slices"
    assert job.calibration == {"slices": 0.88}


def test_pair_of_the_gear_mesh_component():
    job = read_gear_file(component_folder("gear_mesh") / "gear_pair.toml")
    assert job.pair == gear_pair(THESIS)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('"3.5 mm"', '"3.5 inch"', "normal_module: unit 'inch' is no length; it takes m, mm, um"),
        ('"3.5 mm"', '"3.5"', "unit 'none' is no length"),
        ('"3.5 mm"', '"large"', "normal_module = 'large' is no length; give a number in SI or"),
        ('"30 deg"', '"30 mm"', "helix_angle: unit 'mm' is no angle; it takes rad, deg"),
        ('"30 deg"', "30.0", "angles are given in rad"),
        ("[27, 81]", "[27.5, 81]", "number_of_teeth = 27.5 must be an integer"),
        ("helix_angle", "helix", "[gear_pair] helix is unknown; it takes"),
        ("normal_module", "#", "[gear_pair] normal_module is missing"),
        ("[table]", "[tables]", "[tables] is unknown; it takes gear_pair, modification, table"),
        ("corner_contact = true", "corner_contact = 1", "corner_contact = 1 must be true or false"),
        ("[27, 81]", "[27, 81", "cannot read"),
        ("[table.calibration]\nslices", "calibration",
         "calibration = 0.88 belongs to a method; write [table.calibration], slices = 0.88"),
        ("slices = 0.88", 'slices = "much"', "[table] calibration slices = 'much' is no number"),
        ('"slices"', "3", "[table] method = 3 must be a text"),
        ('"5 um"', '"-5 um"', "not negative"),
        ("[modification]", "[deviations]\n[modification]",
         "deviations of teeth take a grade, or files left and right"),
        ("[modification]", '[deviations]\ngrade = 6\nleft = "a.csv"\n[modification]',
         "take a grade, or files left and right; they have grade = 6, left"),
        ("[modification]", "[deviations]\ngrade = 6.5\n[modification]", "must be an integer"),
        ("[modification]", "[deviations]\ngrade = [6, 6, 6]\n[modification]", "one or two classes"),
        ("[modification]", "[deviations]\nleft = 6\n[modification]", "left = 6 must be a text"),
        ("[modification]", "[deviations]\ngrade = 60\n[modification]",
         "bad.toml: [deviations] grade = 60, seed = 0: ISO 1328-1 tolerance class 60 must be an "
         "integer from 1 to 11"),
        ("[modification]", "[deviations]\ngrade = 6\nseed = -1\n[modification]",
         "[deviations] grade = 6, seed = -1: seed -1 of the tooth deviations must be zero or"),
        ("face_width", 'shaft_diameter = ["110 mm", "80 mm"]\nstub_length = "80 mm"\nface_width',
         "pinion: shaft_diameter 110 mm must not be larger than the root diameter 100.3692 mm"),
    ],
)  # fmt: skip
def test_bad_gear_file(message, old, new, expected):
    assert expected in message(old, new)


def test_deviations_of_a_class(tmp_path):
    """Two classes are those of pinion and wheel; halves are cut on their own."""
    file = tmp_path / "pair.toml"
    file.write_text(GOOD + "[deviations]\ngrade = [5, 7]\nseed = 3\n", encoding="utf-8")
    job = read_gear_file(file)
    left, right = job.deviations.of_halves(job.pair)
    for ours, wanted in zip(left, deviations(job.pair, (5, 7), 3, 0), strict=True):
        assert np.array_equal(ours.cumulative_pitch, wanted.cumulative_pitch)
    assert not np.array_equal(left[0].helix_slope, right[0].helix_slope)
    assert str(job.deviations) == "teeth deviate as ISO 1328-1 class 5 and 7 lets pass, seed 3"
    coast = job.deviations.of_coast_flanks(job.pair)[1]
    wanted = deviations(job.pair, (5, 7), 3, 1, coast=True)
    assert np.array_equal(coast[1].helix_slope, wanted[1].helix_slope)


def test_deviations_of_files_beside_the_gear_file(tmp_path):
    file = tmp_path / "pair.toml"
    file.write_text(GOOD + '[deviations]\nleft = "l.csv"\nright = "r.csv"\n', encoding="utf-8")
    job = read_gear_file(file)
    for half, name in enumerate(("l.csv", "r.csv")):
        write_deviations(deviations(job.pair, 6, 1, half), tmp_path / name)
    right = job.deviations.of_halves(job.pair)[1]
    wanted = deviations(job.pair, 6, 1, 1)
    assert np.array_equal(right[1].profile_slope, wanted[1].profile_slope)
    assert job.deviations.of_coast_flanks(job.pair) == []
    write_deviations(wanted, tmp_path / "r.csv", deviations(job.pair, 6, 1, 1, coast=True))
    with pytest.raises(HerringboneError, match=r"one of .*l\.csv and .*r\.csv has no columns of"):
        job.deviations.of_coast_flanks(job.pair)


def test_missing_gear_file(tmp_path):
    with pytest.raises(HerringboneError, match=r"cannot read .*none\.toml"):
        read_gear_file(tmp_path / "none.toml")


def test_loads_follow_from_the_torque():
    """From zero to 25 times the normal force; without a torque 100 N/mm of tangential load."""
    job = GearJob(gear_pair(THESIS), torque=200.0)
    loads = job.task().loads
    assert loads[0] == 0.0
    assert loads[-1] == pytest.approx(25.0 * 2252.228)
    forces = gear_pair(THESIS).tooth_forces(GearJob(gear_pair(THESIS)).pinion_torque)
    assert forces.pair.tangential_reference / (2 * 47.3) == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"loads": [100.0, 1e4]}, "must begin with zero and go on, in N per half; they begin with"),
        ({"loads": []}, "they begin with nothing"),
        ({"loads": [0.0, 1000.0]}, "largest load 1000 N of the stiffness table is below the 2252"),
        ({"torque": -1.0}, "torque -1 N m must be positive"),
        ({"phases": 2}, "phases = 2 must lie between 4 and 128"),
        ({"calibration": {"fe": 1.0}}, "method 'fe' is unknown; it is of slices or coupled-slices"),
    ],
)
def test_tables_without_zero_or_large_loads(changes, expected):
    with pytest.raises(ParameterError, match=re.escape(expected)):
        GearJob(**{"pair": gear_pair(THESIS), "torque": 200.0, **changes}).task()
