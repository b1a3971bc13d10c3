"""Geometry of gear pairs: identities, generated teeth, and what is refused."""

import math

import numpy as np
import pytest
from support.gearing.gears import HELICAL, SPUR, THESIS, gear_pair

from herringbone.core import ParameterError
from herringbone.gears.geometry.involute import involute, involute_angle


@pytest.mark.parametrize("data", [THESIS, SPUR, HELICAL], ids=["thesis", "spur", "helical"])
@pytest.mark.parametrize("gear", [0, 1])
def test_cut_tooth_is_involute_and_trochoid(data, gear):
    """Fillet from the root circle, without step or kink into the involute, up to the tip."""
    pair = gear_pair(data)
    profile = pair.tooth_profile(gear, points=400)
    fillet, flank = profile.fillet, profile.flank
    assert np.hypot(*fillet[0]) == pytest.approx(pair.root_radius[gear], abs=1e-12)
    assert np.hypot(*flank[-1]) == pytest.approx(pair.tip_radius[gear], abs=1e-12)
    assert fillet[-1] == pytest.approx(flank[0], abs=1e-12)
    before, after = np.diff(fillet[-2:], axis=0)[0], np.diff(flank[:2], axis=0)[0]
    turned = math.atan2(*before) - math.atan2(*after)
    assert abs(turned) < 5e-3
    tangent = np.gradient(flank, axis=0)[1:-1]
    along_tangent = np.abs(np.sum(flank[1:-1] * tangent, axis=1)) / np.hypot(*tangent.T)
    assert along_tangent == pytest.approx(pair.base_radius[gear], rel=1e-4)


def test_fillet_of_a_rounded_rack_keeps_outside_the_root():
    profile = gear_pair(THESIS).tooth_profile(0)
    radius = np.hypot(*profile.points.T)
    assert np.all(np.diff(radius) > -1e-12)
    assert np.all(np.diff(profile.points[:, 0]) < 0.0)


def test_undercut_tooth_that_does_not_touch_there():
    """FZG type A: the wheel (x = -0.5) is undercut below its active flank, as it is cut and used.

    Fillet and involute meet in a corner, above the base circle, below the lowest contact.
    """
    pair = gear_pair(SPUR, face_width=20e-3, profile_shift_coefficient=(0.8635, -0.5))
    profile = pair.tooth_profile(1)
    assert profile.undercut
    assert not pair.tooth_profile(0).undercut
    assert profile.fillet[-1] == pytest.approx(profile.flank[0], abs=1e-9)
    path = pair.path_of_contact
    lowest = math.hypot(pair.base_radius[1], path.tangent_length - path.end)
    assert pair.base_radius[1] < profile.form_radius < lowest
    assert [2e3 * r for r in pair.tip_radius] == pytest.approx((88.77, 112.5), abs=5e-3)


def test_involute_angle_inverts():
    for degrees in (0.0, 5.0, 20.0, 35.0, 70.0):
        angle = math.radians(degrees)
        assert involute_angle(involute(angle)) == pytest.approx(angle, abs=1e-12)


def test_center_distance_and_profile_shift_follow_from_each_other():
    given = gear_pair(HELICAL, center_distance=None)
    assert given.normal_backlash == pytest.approx(0.0, abs=1e-15)
    assert given.center_distance == pytest.approx(0.861, abs=2e-5)
    back = gear_pair(
        HELICAL, center_distance=given.center_distance, profile_shift_coefficient=(0.480, None)
    )
    assert back.profile_shift_coefficient == pytest.approx((0.480, 0.669), abs=1e-9)
    shared = gear_pair(
        HELICAL, center_distance=given.center_distance, profile_shift_coefficient=None
    )
    assert shared.profile_shift_coefficient == pytest.approx((0.5745, 0.5745), abs=1e-9)


def test_thinner_teeth_give_backlash():
    """j_bn = -(E_sn1 + E_sn2) cos(alpha_n) at the zero-backlash centre distance."""
    reference = gear_pair(THESIS).center_distance
    pair = gear_pair(THESIS, tooth_thickness_allowance=(-60e-6, -40e-6), center_distance=reference)
    assert pair.normal_backlash == pytest.approx(100e-6 * math.cos(math.radians(20.0)), rel=1e-9)


def test_hand_and_order_of_the_gears():
    """The other hand has the same teeth; pinion and wheel exchange their values."""
    pair, mirrored = gear_pair(THESIS), gear_pair(THESIS, helix_angle=math.radians(-30.0))
    assert mirrored.base_helix_angle == -pair.base_helix_angle
    assert mirrored.total_contact_ratio == pair.total_contact_ratio
    assert np.array_equal(mirrored.tooth_profile(0).points, pair.tooth_profile(0).points)
    swapped = gear_pair(SPUR, number_of_teeth=(24, 16), profile_shift_coefficient=(0.1715, 0.1817))
    first, second = gear_pair(SPUR), swapped
    assert second.tip_radius == first.tip_radius[::-1]
    assert second.length_of_path_of_contact == pytest.approx(
        first.length_of_path_of_contact, rel=1e-13
    )


def test_dimensions_scale():
    """All lengths twice: ratios stay, masses grow by 8, inertias by 32, stiffness by 2."""
    lengths = ("normal_module", "face_width", "gap_width", "stub_length")
    twice = {name: 2.0 * THESIS[name] for name in lengths}
    for name in ("groove_diameter", "shaft_diameter"):
        twice[name] = tuple(2.0 * d for d in THESIS[name])
    small, large = gear_pair(THESIS), gear_pair(THESIS, **twice)
    assert large.total_contact_ratio == pytest.approx(small.total_contact_ratio, rel=1e-13)
    for one, two in zip(small.half_body, large.half_body, strict=True):
        assert two.mass == pytest.approx(8.0 * one.mass, rel=1e-12)
        assert two.inertia == pytest.approx(32.0 * one.inertia, rel=1e-12)
    for one, two in zip(small.gap_shaft, large.gap_shaft, strict=True):
        assert two.axial == pytest.approx(2.0 * one.axial, rel=1e-12)
        assert two.radial == pytest.approx(2.0 * one.radial, rel=1e-12)
        assert two.torsional == pytest.approx(8.0 * one.torsional, rel=1e-12)
    assert large.iso6336_stiffness().normal == pytest.approx(
        2.0 * small.iso6336_stiffness().normal, rel=1e-12
    )


BAD = {
    "undercut": (THESIS, {"number_of_teeth": (8, 81)}, "pinion: teeth are undercut"),
    "undercut spur": (
        SPUR,
        {"number_of_teeth": (12, 40), "center_distance": None, "profile_shift_coefficient": 0.0},
        "pinion: teeth are undercut",
    ),
    "pointed": (SPUR, {"center_distance": None, "profile_shift_coefficient": (1.3, 0)}, "pointed"),
    "huge profile shift": (
        SPUR,
        {"center_distance": None, "profile_shift_coefficient": (1e9, 0)},
        "x1 \\+ x2 = 1e\\+09 leave no working pressure angle; use a smaller sum",
    ),
    "contact ratio": (SPUR, {"addendum_coefficient": 0.6}, "contact ratio 0.9"),
    "impossible center distance": (THESIS, {"center_distance": 0.19}, "19.*impossible"),
    "far center distance": (SPUR, {"center_distance": 0.0960}, "contact ratio"),
    "negative backlash": (THESIS, {"center_distance": 0.2179}, "backlash is negative: -2"),
    "tips in the root": (THESIS, {"addendum_coefficient": 1.3}, "reach its root"),
    "nothing to go by": (THESIS, {"profile_shift_coefficient": None}, "both missing"),
    "millimetres": (THESIS, {"normal_module": 3.5}, "lengths are given in m"),
    "degrees": (THESIS, {"helix_angle": 30.0}, "angles are given in rad"),
    "pressure angle in degrees": (THESIS, {"normal_pressure_angle": 20.0}, "given in rad"),
    "half teeth": (THESIS, {"number_of_teeth": (27.5, 81)}, "27.5 must be an integer"),
    "no number": (THESIS, {"face_width": math.nan}, "face_width = nan"),
    "missing": (THESIS, {"normal_module": None}, "normal_module = None"),
    "text": (THESIS, {"face_width": "47.3"}, "face_width = '47.3'"),
    "three values": (THESIS, {"bore_diameter": (0.0, 0.0, 0.0)}, "bore_diameter: 3 values"),
    "bore": (THESIS, {"bore_diameter": (0.2, 0.0)}, "pinion: bore diameter 200 mm"),
    "halves": (THESIS, {"halves": 3}, "halves = 3"),
    "fillet": (THESIS, {"root_fillet_radius_coefficient": 0.6}, "between 0 and 0.47"),
    "thick teeth": (THESIS, {"tooth_thickness_allowance": 1e-5}, "must not be positive"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_clear_line(case):
    data, changes, message = BAD[case]
    with pytest.raises(ParameterError, match=message) as error:
        gear_pair(data, **changes)
    assert "\n" not in str(error.value)


def test_single_helix_has_no_gap_shaft():
    with pytest.raises(ParameterError, match="no gap shaft"):
        _ = gear_pair(SPUR).gap_shaft
