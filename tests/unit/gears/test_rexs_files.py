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


def stage_with(tmp_path, components="", relations="", **replaced):
    """The stage with components and relations added, and texts of attributes replaced by name."""
    text = STAGE.read_text(encoding="utf-8")
    for place, more in (("components", components), ("relations", relations)):
        text = text.replace(f"</{place}>", f"{more}</{place}>")
    for name, value in replaced.items():
        text = re.sub(rf'(id="{name}" unit="[^"]*">)[^<]*', rf"\g<1>{value}", text)
    file = tmp_path / "stage.rexs"
    file.write_text(text, encoding="utf-8")
    return file


def component(number, kind, **attributes):
    lines = "".join(
        f'<attribute id="{name}" unit="{unit}">{value}</attribute>'
        for name, (value, unit) in attributes.items()
    )
    return f'<component id="{number}" name="Part {number}" type="{kind}">{lines}</component>'


def relation(kind, order="", **roles):
    refs = "".join(f'<ref role="{role}" id="{number}"/>' for role, number in roles.items())
    return f'<relation type="{kind}" order="{order}">{refs}</relation>'


def hob(number, addendum, radius=0.25, **more):
    return component(number, "rack_shaped_tool", tip_radius_factor=(radius, "none"),
                     addendum_coefficient_reference_profile=(addendum, "none"), **more)  # fmt: skip


def steps(tool, order=1, flanks=(13, 14, 15, 16), settings=99):
    return "".join(
        relation(
            "manufacturing_step", order, workpiece=f, tool=tool, manufacturing_settings=settings
        )
        for f in flanks
    )


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
        ('12" name="Wheel" type="cylindrical_gear"', '12" name="Wheel" type="ring_gear"',
         "ring_gear 'Wheel' of stage 'First stage' is an internal gear; only external pairs"),
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
    """They are components of their own."""
    more = "".join(
        f'<component id="{30 + i}" type="{kind}"/>'
        for i, kind in enumerate(("tip_relief", "helix_crowning", "tip_relief", "worm_gear_flank"))
    )
    file = tmp_path / "relieved.rexs"
    text = STAGE.read_text(encoding="utf-8").replace("</components>", f"{more}</components>")
    file.write_text(text, encoding="utf-8")
    line = read_job(file).unread[-1]
    assert "relieved.rexs: modifications of flanks are not read (1 helix_cr" in line
    assert "2 tip_relief)" in line
    assert line in pair_values(read_mounted_job(file))[1]
    assert not any("flanks" in line for line in read_job(STAGE).unread)


def test_each_kind_of_flank_modification_is_named(tmp_path):
    """The fourteen types of REXS 1.2 to 2.0; a crowned roller of a bearing is none."""
    kinds = [
        *("tip_relief", "root_relief", "triangular_tip_relief", "triangular_root_relief"),
        *("end_relief_datum_face", "end_relief_non_datum_face", "topographical_modification"),
        *("helix_crowning", "helix_slope", "helix_deviation"),
        *("profile_crowning", "profile_slope", "profile_twist", "profile_deviation"),
    ]
    more = "".join(component(30 + i, kind) for i, kind in enumerate([*kinds, "roller_crowning"]))
    line = read_job(stage_with(tmp_path, more)).unread[-1]
    assert f"({', '.join(f'1 {kind}' for kind in sorted(kinds))})" in line


def test_topographical_deviations_of_flanks_are_named(tmp_path):
    text = STAGE.read_text(encoding="utf-8")
    matrix = '<attribute id="topographical_deviation_amounts" unit="mm"><matrix/></attribute>'
    flank = '<component id="14" name="Pinion, right flank" type="cylindrical_gear_flank">'
    assert flank in text
    file = tmp_path / "measured.rexs"
    file.write_text(text.replace(flank, flank + matrix), encoding="utf-8")
    line = read_job(file).unread[-1]
    assert "(1 flanks with topographical_deviation), the flanks are plain" in line


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


def test_what_a_stage_does_not_tell_of_both_halves_is_said():
    """Its width is that of a half, its hand that of the left one; it has no gap."""
    notes = pair_values(read_mounted_job(STAGE))[1]
    assert any("a REXS stage has one face width, 50 mm; it is taken as that" in x for x in notes)
    assert any(
        "has no gap between the halves and no shaft stubs, which are taken as 0, and one helix "
        "angle, 21 deg, which is taken as that of the left half" in note
        for note in notes
    )
    assert not any("REXS stage" in line for line in read_job(STAGE).unread)


def test_other_xml(tmp_path):
    file = tmp_path / "page.xml"
    file.write_text("<html/>", encoding="utf-8")
    with pytest.raises(HerringboneError, match="root element 'html' is not the 'model'"):
        read_rexs_job(file)


# -- tools ----------------------------------------------------------------------------------------


def test_tool_of_the_flanks_gives_the_root(tmp_path):
    """d_f = z m_n / cos(beta) - 2 m_n (h_fP - x), with h_fP = h_aP0 of the hob; not all of it."""
    settings = component(41, "cylindrical_gear_manufacturing_settings",
                         generated_addendum_modification_coefficient=(0.19, "none"))  # fmt: skip
    cutting = hob(40, 1.4, tip_diameter=(90, "mm"), protuberance_amount=(0, "mm"))
    job = read_job(stage_with(tmp_path, cutting + settings, steps(40, settings=41)))
    module = 4.5e-3
    for gear, teeth in enumerate((27, 51)):
        expected = teeth * module / math.cos(math.radians(21.0)) - 2.0 * module * (1.4 - 0.231415)
        assert 2.0 * job.pair.root_radius[gear] == pytest.approx(expected, rel=1e-12)
    assert job.pair.root_fillet_radius_coefficient == (0.25, 0.25)
    assert job.pair.tip_radius == read_rexs_job(STAGE).pair.tip_radius
    pinion = next(line for line in job.unread if "'Pinion' is cut by" in line)
    assert pinion.endswith(
        "rack_shaped_tool 'Part 40'; not read: generated_addendum_modification_coefficient = 0.19"
    )


def test_tools_up_to_rexs_1_2_are_those_of_the_gear(tmp_path):
    before = relation("ordered_reference", 1, origin=12, referenced=40)
    pair = read_rexs_job(stage_with(tmp_path, hob(40, 1.4), before)).pair
    assert pair.dedendum_coefficient == (1.25, 1.4)
    assert pair.root_fillet_radius_coefficient[1] == 0.25


def test_the_last_of_several_tools_is_taken(tmp_path):
    """By the order of the steps, which is not that of the file."""
    job = read_job(
        stage_with(tmp_path, hob(40, 1.4) + hob(41, 1.3, 0.3), steps(41, 2) + steps(40, 1))
    )
    assert job.pair.dedendum_coefficient == (1.3, 1.3)
    said = "'Part 40', rack_shaped_tool 'Part 41': the root is that of rack_shaped_tool 'Part 41'"
    assert sum(said in line for line in job.unread) == 2


def test_tools_that_are_not_read_are_named(tmp_path):
    other = hob(40, 1.4, normal_module=(4.0, "mm"))
    job = read_job(stage_with(tmp_path, other, steps(40)))
    assert job.pair == read_job(STAGE).pair
    assert sum("'Part 40': not read for want of addendum" in line for line in job.unread) == 2
    cutter = hob(40, 1.3, number_of_teeth=(23, "none")).replace("rack_shaped", "cutter_wheel")
    job = read_job(stage_with(tmp_path, cutter, steps(40)))
    assert job.pair.number_of_teeth == (27, 51)
    assert sum("the root is that of a rack with the cutter's" in line for line in job.unread) == 2


def test_tools_of_both_flanks_must_be_the_same(tmp_path):
    file = stage_with(
        tmp_path, hob(40, 1.4) + hob(41, 1.3), steps(40, flanks=[13]) + steps(41, flanks=[14])
    )
    with pytest.raises(HerringboneError, match="'Pinion': the tools of its flanks differ in adden"):
        read_rexs_job(file)


# -- materials ------------------------------------------------------------------------------------

NYLON = component(42, "material", elastic_modulus=("3000", "N / mm^2"),
                  poisson_ratio=("0.38", "none"), density=("1.14", "kg / dm^3"))  # fmt: skip


def test_own_material_goes_before_that_of_the_shaft(tmp_path):
    """In whatever order the relations are; the wheel, without material, takes the pinion's."""
    own = relation("reference", origin=11, referenced=42)
    file = stage_with(tmp_path, NYLON, own)
    last = read_job(file)
    text = file.read_text(encoding="utf-8").replace(own, "")
    file.write_text(text.replace("<relations>", f"<relations>{own}"), encoding="utf-8")
    assert read_job(file) == last
    assert last.pair.youngs_modulus == 3e9
    assert last.pair.density == 1140.0
    (line,) = last.unread
    assert line.endswith("'Wheel' has no material; material 'Part 42' is taken")


def test_materials_that_differ(tmp_path):
    """ISO 6336-1: E = 2 E1 E2 / (E1 + E2)."""
    job = read_job(stage_with(tmp_path, NYLON, relation("reference", origin=12, referenced=42)))
    assert job.pair.youngs_modulus == pytest.approx(2.0 * 210e9 * 3e9 / 213e9, rel=1e-12)
    assert job.pair.density == pytest.approx(0.5 * (7850.0 + 1140.0), rel=1e-12)
    (line,) = job.unread
    assert "'Pinion' and cylindrical_gear 'Wheel' differ" in line
    assert "elastic_modulus 210 GPa and 3 GPa, taken 5.915 GPa" in line
    assert "density 7850 kg/m3 and 1140 kg/m3, taken 4495 kg/m3" in line


def test_steel_that_is_assumed_is_said(tmp_path):
    file = stage_with(tmp_path)
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace('type="reference"', "").replace('"referenced"', '"other"'))
    job = read_job(file)
    assert job.pair.youngs_modulus == 2.06e11
    (line,) = job.unread
    assert "the gears have no material; steel is taken: elastic_modulus 206 GPa, poi" in line
    file.write_text(text.replace('id="density"', 'id="mass_density"'), encoding="utf-8")
    lines = read_job(file).unread
    assert any("'Steel' has no density; that of steel is taken, 7850 kg/m3" in x for x in lines)


# -- geometry that a file may state ---------------------------------------------------------------


def with_attributes(file, part, **attributes):
    """Attributes (value, unit) put into the component of this number."""
    lines = "".join(
        f'<attribute id="{name}" unit="{unit}">{value}</attribute>'
        for name, (value, unit) in attributes.items()
    )
    text = file.read_text(encoding="utf-8")
    pattern = rf'(<component id="{part}"[^/>]*>)'
    file.write_text(re.sub(pattern, rf"\g<1>{lines}", text, count=1), encoding="utf-8")
    return file


def test_addendum_of_the_flanks(tmp_path):
    """r_a = r + m_n (h_aP + x), unless there is a tip diameter."""
    plain = read_job(STAGE).pair
    file = stage_with(tmp_path)
    for flank in (13, 14, 15, 16):
        with_attributes(file, flank, addendum_coefficient_basic_profile=(0.9, "none"))
    pair = read_job(file).pair
    assert pair.tip_radius[0] == pytest.approx(plain.tip_radius[0] - 0.45e-3, abs=1e-12)
    pair = read_job(with_attributes(file, 11, tip_diameter=(141.0, "mm"))).pair
    assert pair.tip_radius[0] == pytest.approx(70.5e-3, abs=1e-12)
    assert pair.tip_radius[1] == pytest.approx(plain.tip_radius[1] - 0.45e-3, abs=1e-12)


def test_root_diameter_holds_where_there_is_no_tool(tmp_path):
    file = with_attributes(stage_with(tmp_path), 11, root_diameter=(119.8, "mm"))
    job = read_job(file)
    assert job.pair.root_radius[0] == pytest.approx(59.9e-3, abs=1e-12)
    assert not any("root_diameter 1" in line for line in job.unread)
    cut = stage_with(tmp_path, hob(40, 1.4), steps(40))
    job = read_job(with_attributes(cut, 11, root_diameter=(119.8, "mm")))
    said = "'Pinion': root_diameter 119.8000 mm is not read; by the tool it is 119.6269 mm"
    assert any(said in line for line in job.unread)


def test_common_face_width_and_backlash_of_the_stage(tmp_path):
    """The mean of the least and the largest backlash, and no line that one is assumed."""
    file = with_attributes(stage_with(tmp_path), 10, common_face_width=(30, "mm"),
                           minimum_normal_backlash=(0.2, "mm"),
                           maximum_normal_backlash=(0.3, "mm"))  # fmt: skip
    values, notes = pair_values(read_mounted_job(file))
    assert values.face_width == 0.03
    assert values.backlash == pytest.approx(250e-6, rel=1e-12)
    assert not any("assumed" in note for note in notes)
    assert any("assumed" in note for note in pair_values(read_mounted_job(STAGE))[1])


def test_thickness_and_chamfers_that_are_not_read_are_named(tmp_path):
    file = with_attributes(stage_with(tmp_path), 11, normal_tooth_thickness=(7, "mm"),
                           chordal_tooth_thickness_upper_deviation=(-0.1, "mm"))  # fmt: skip
    for flank, chamfer in ((13, 0.4), (14, 0.4), (15, 0.0), (16, 0.0)):
        with_attributes(file, flank, tooth_tip_chamfer=(chamfer, "mm"))
    (line,) = (line for line in read_job(file).unread if "not read" in line)
    assert "cylindrical_gear 'Pinion': not read: chordal_tooth_thickness_upper_deviation" in line
    assert "_deviation = -0.1 mm, tooth_tip_chamfer = 0.4 mm; in a gear file" in line
