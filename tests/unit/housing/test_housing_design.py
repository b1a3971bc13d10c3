"""The file of a housing's dimensions, and the message for each kind of bad one."""

import pytest

from herringbone.core import ParameterError
from herringbone.core.places.paths import component_folder
from herringbone.housing.welded.design import read_design

SHIPPED = component_folder("modal_housing") / "welded_housing.toml"
TEXT = SHIPPED.read_text(encoding="utf-8")


@pytest.fixture
def message(tmp_path):
    def refuse(old: str, new: str) -> str:
        assert old in TEXT
        file = tmp_path / "box.toml"
        file.write_text(TEXT.replace(old, new, 1), encoding="utf-8")
        with pytest.raises(ParameterError) as caught:
            read_design(file)
        text = str(caught.value)
        assert text.startswith(str(file)) or f"cannot read {file}" in text
        assert "\n" not in text
        return text

    return refuse


def test_shipped_dimensions_in_metres():
    design = read_design(SHIPPED)
    assert design.dimensions.center_distance == pytest.approx(0.2182, rel=1e-15)
    assert design.dimensions.bolts_per_side == 3
    assert design.mesh_size == pytest.approx(0.016, rel=1e-15)
    assert design.material.young_modulus == 210e9


def test_metres_are_the_same(tmp_path):
    """All lengths of the file a thousandth, in m."""
    head, rest = TEXT.replace('"mm"', '"m"').split("[material]")
    lines = []
    for line in head.splitlines():
        name, equals, value = line.partition(" = ")
        length = equals and name not in {"description", "length_unit", "bolts_per_side"}
        lines.append(f"{name} = {float(value) * 1e-3!r}" if length else line)
    file = tmp_path / "metres.toml"
    file.write_text("\n".join(lines) + "\n[material]" + rest)
    assert read_design(file) == read_design(SHIPPED)


BAD = [
    ("base_plate = 20.0\n", "", "[dimensions]: base_plate: missing"),
    ("floor = 17.0", "flor = 17.0", "[dimensions]: floor: missing"),
    ("cover = 10.0", "cover = 10.0\nlid = 3.0", "[dimensions]: lid: unknown"),
    ("[sensors]", "[gauges]", "sensors: missing"),
    ('"mm"', '"inch"', "length_unit = 'inch'; it must be one of mm, m"),
    ('"mm"', '["mm"]', "length_unit = ['mm']; it must be one of mm, m"),
    ('"mm"', '"m"', "mesh size 16 m: it must be from 0.005 to 0.2 m"),
    ("mesh_size = 16.0", "mesh_size = 0.016", "mesh size 1.6e-05 m: it must be from 0.005"),
    ("cover = 10.0", "cover = 0.01", "cover = 1e-05 m: it must be from 0.0005 to 5 m; is length"),
    ("floor = 17.0", "floor = -17.0", "floor = -0.017 m: it must be from"),
    ("end_wall = 12.0", "end_wall = nan", "dimensions.end_wall = nan is not a finite number"),
    ("end_wall = 12.0", 'end_wall = "12"', "end_wall = '12': it takes a finite number"),
    ("per_side = 3", "per_side = 3.0", "bolts_per_side = 3.0: it takes an integer"),
    ("per_side = 3", "per_side = 1", "bolts_per_side = 1: it must be from 2 to 1000"),
    ("per_side = 3", "per_side = 40", "bolt_diameter = 0.022 m must be less than the bolts' pitch"),
    ("pinion_bore = 90.0", "pinion_bore = 191.0",
     "pinion_bore / 2 = 0.0955 m must be less than pinion_end_clearance = 0.095 m"),
    ("wheel_bore = 120.0", "wheel_bore = 500.0", "wheel_bore / 2 = 0.25 m must be less than wheel"),
    ("cover_height = 190.0", "cover_height = 55.0", "the larger bore's radius = 0.06 m"),
    ("boss_wall = 20.0", "boss_wall = 60.0", "the sum of the bosses' radii = 0.225 m must be less"),
    ("flange_width = 40.0", "flange_width = 40.1",
     "flange_width = 0.0401 m must be at most boss_length = 0.04 m"),
    ("rib_depth = 35.0", "rib_depth = 41.0",
     "rib_depth = 0.041 m must be at most boss_length = 0.04 m"),
    ("foot_length = 132.0", "foot_length = 300.0", "2 foot_length = 0.6 m must be less than"),
    ("foot_thickness = 13.0", "foot_thickness = 210.0", "foot_thickness / 2 = 0.105 m"),
    ("foot_position = 102.5", "foot_position = 110.0", "the outer face of the side wall = 0.114 m"),
    ("base_overhang_z = 57.0", "base_overhang_z = 25.0", "the inner edge of the bolt holes"),
    ("bolt_end_distance = 27.0", "bolt_end_distance = 10.0", "the bolts' distance from the edges"),
    ("poisson_ratio = 0.3", "poisson_ratio = 0.5", "poisson_ratio = 0.5: it must be from 0"),
    ("young_modulus = 210e9", "young_modulus = 0.0",
     "young_modulus = 0 Pa must lie between 1e+08 and 1e+12 Pa"),
    ("young_modulus = 210e9", "young_modulus = 210e3", "Pa; write 2.1e+11 if 210000 MPa are meant"),
    ("density = 7850.0", "density = 7.85e-9",
     "density = 7.85e-09 kg/m3 must lie between 500 and 25000 kg/m3; write 7850 if 7.85e-09 t/mm3"),
    ("density = 7850.0", "density = 7.85", "; write 7850 if 7.85 g/cm3 are meant"),
    ("band_hz = 2000.0", "band_hz = 0.0", "band_hz = 0 Hz: it must be positive"),
    ("damping_ratio = 0.01", "damping_ratio = 1.5", "damping_ratio = 1.5: it must be between"),
    ('end = "left"', 'end = "front"', "end = 'front': it must be left or right"),
    ("[material]", "[material", "cannot read"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "expected"), BAD)
def test_bad_files(message, old, new, expected):
    assert expected in message(old, new)


def test_no_such_file(tmp_path):
    with pytest.raises(ParameterError, match=r"cannot read .*none.toml: .*No such file"):
        read_design(tmp_path / "none.toml")
