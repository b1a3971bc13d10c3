"""Gear pairs of REXS files: what is read and chosen, and the message for each kind of bad one."""

import math
import re
from pathlib import Path

import pytest

from herringbone.core import HerringboneError
from herringbone.gears.files.read_job import read_job, read_mounted_job
from herringbone.gears.files.rexs import read_rexs_job
from herringbone.gears.pair_values import pair_values

STAGE = Path(__file__).parents[2] / "gear_stage.rexs"
"""First stage of the FVA two-stage industrial gear unit, as its public REXS model has it."""


def test_rexs_stage():
    """Its centre distance is that of its profile shifts without backlash, to the digits given."""
    pair = read_rexs_job(STAGE).pair
    assert pair.number_of_teeth == (27, 51)
    assert pair.helix_angle == math.radians(21.0)
    assert pair.center_distance == 0.190
    assert abs(pair.normal_backlash) < 1e-7
    assert pair.youngs_modulus == 2.1e11
    assert pair.density == 7850.0
    assert pair.halves == 1


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('id="normal_module" unit="mm">4.5', 'id="modul" unit="mm">4.5',
         "cylindrical_gear 'Pinion', normal_module is missing"),
        ('"normal_pressure_angle" unit="deg"', '"normal_pressure_angle" unit="rad/s"',
         "normal_pressure_angle: unit 'rad/s' is no angle; it takes rad, deg"),
        ('"center_distance" unit="mm"', '"center_distance" unit="inch"',
         "cylindrical_stage 'First stage', center_distance: unit 'inch' is no length"),
        ('"center_distance"', '"distance"', "center_distance is missing"),
        ('"addendum_modification_coefficient"', '"x"', "addendum_modification_coefficient is mis"),
        ('deg">-21', 'deg">21', "helix angles 21 and 21 deg of an external pair must be opposite"),
        ('unit="">27', 'unit="">many', "number_of_teeth: 'many' is not a finite number"),
        ('unit="">27', 'unit="">27.5', "number of teeth 27.5 must be an integer"),
        ('type="cylindrical_stage"', 'type="bevel_stage"', "it has no cylindrical_stage"),
        ('role="gear_2"', 'role="gear_3"', "has no relation to two cylindrical_gears"),
        ("<model", "<models", "is not well-formed"),
        ('mm">190', 'mm">18', "bad.rexs: center distance 18.0000 mm is impossible"),
        ('"face_width" unit="mm"', '"face_width" unit="m"', "bad.rexs: face_width = 50 m is 384"),
    ],
)  # fmt: skip
def test_bad_rexs(tmp_path, old, new, expected):
    text = STAGE.read_text(encoding="utf-8")
    assert old in text
    file = tmp_path / "bad.rexs"
    file.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(HerringboneError, match=re.escape(expected)) as caught:
        read_rexs_job(file)
    assert "\n" not in str(caught.value)


def test_modifications_in_rexs_are_named(tmp_path):
    """REXS 1.4 has them as components of their own."""
    more = "".join(
        f'<component id="{30 + i}" type="{kind}"/>'
        for i, kind in enumerate(("tip_relief", "helix_crowning", "tip_relief", "worm_gear_flank"))
    )
    file = tmp_path / "relieved.rexs"
    text = STAGE.read_text(encoding="utf-8").replace("</components>", f"{more}</components>")
    file.write_text(text, encoding="utf-8")
    (line,) = read_job(file).unread
    assert "relieved.rexs: modifications of flanks are not read (1 helix_cr" in line
    assert "2 tip_relief)" in line
    assert pair_values(read_mounted_job(file))[1][0] == line
    assert read_job(STAGE).unread == ()


def test_flanks_that_differ(tmp_path):
    text = STAGE.read_text(encoding="utf-8").replace("0.231415", "0.231", 1)
    file = tmp_path / "unequal.rexs"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(HerringboneError, match="'Pinion' has several values of addendum_mod"):
        read_rexs_job(file)


def test_stage_is_chosen(tmp_path):
    text = STAGE.read_text(encoding="utf-8")
    second = '<component id="20" name="Second stage" type="cylindrical_stage"/></components>'
    file = tmp_path / "two.rexs"
    file.write_text(text.replace("</components>", second), encoding="utf-8")
    names = r"10 \(First stage\), 20 \(Second stage\)"
    with pytest.raises(HerringboneError, match=rf"{names}; choose one .*{file.name}#10 "):
        read_rexs_job(file)
    assert read_rexs_job(file, stage="First stage").pair == read_rexs_job(file, stage="10").pair
    with pytest.raises(HerringboneError, match="stage 'Third' is none of"):
        read_rexs_job(file, stage="Third")
    chosen = read_mounted_job(file.with_name(f"{file.name}#10"))
    assert chosen.pair == read_rexs_job(file, stage="10", halves=2).pair
    with pytest.raises(HerringboneError, match="--stage is of REXS files only"):
        read_mounted_job(tmp_path / "own.toml#10")


def test_other_xml(tmp_path):
    file = tmp_path / "page.xml"
    file.write_text("<html/>", encoding="utf-8")
    with pytest.raises(HerringboneError, match="root element 'html' is not the 'model'"):
        read_rexs_job(file)
