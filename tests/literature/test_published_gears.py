"""Published gears: geometry and stiffness to the digits that are given."""

import math

import pytest
from support.gearing.gears import HELICAL, SPUR, THESIS, gear_pair


def test_thesis_pair_follows_from_its_data():
    """ISO 21771 evaluated by hand for z 27/81, m_n 3.5 mm, 20 deg, 30 deg, no profile shift."""
    pair = gear_pair(THESIS)
    assert pair.transverse_module == pytest.approx(4.041452e-3, abs=5e-10)
    assert math.degrees(pair.transverse_pressure_angle) == pytest.approx(22.7959, abs=5e-5)
    assert math.degrees(pair.base_helix_angle) == pytest.approx(28.0243, abs=5e-5)
    for name, values in {
        "reference_radius": (54.5596, 163.6788),
        "base_radius": (50.2980, 150.8940),
        "tip_radius": (58.0596, 167.1788),
        "root_radius": (50.1846, 159.3038),
    }.items():
        assert [1e3 * r for r in getattr(pair, name)] == pytest.approx(values, abs=5.1e-5)
    assert 1e3 * pair.center_distance == pytest.approx(218.2384, abs=5e-5)
    assert 1e3 * pair.length_of_path_of_contact == pytest.approx(16.4146, abs=5e-5)
    assert 1e3 * pair.transverse_base_pitch == pytest.approx(11.7049, abs=5e-5)
    assert pair.transverse_contact_ratio == pytest.approx(1.40238, abs=5e-6)
    assert pair.overlap_ratio == pytest.approx(2.151, abs=5e-4)
    assert pair.total_contact_ratio == pytest.approx(3.553, abs=5e-4)


def test_thesis_pair_at_the_rounded_center_distance():
    pair = gear_pair(THESIS, center_distance=0.2182)
    assert math.degrees(pair.working_transverse_pressure_angle) == pytest.approx(22.772, abs=5e-4)
    assert pair.transverse_contact_ratio == pytest.approx(1.411, abs=5e-4)


def test_mounting_error_opens_the_backlash():
    """8 um farther: 22.8009 deg, 1.4006, and 2 sin(alpha_n) 8 um = 5.5 um of backlash."""
    pair = gear_pair(THESIS, center_distance=gear_pair(THESIS).center_distance + 8e-6)
    assert math.degrees(pair.working_transverse_pressure_angle) == pytest.approx(22.8009, abs=5e-5)
    assert pair.transverse_contact_ratio == pytest.approx(1.4006, abs=5e-5)
    assert 1e6 * pair.normal_backlash == pytest.approx(5.5, abs=0.05)


def test_thesis_pair_forces_at_200_newton_metres():
    pair = gear_pair(THESIS)
    forces = pair.tooth_forces(200.0)
    assert forces.pair.tangential_reference == pytest.approx(3665.7, abs=0.05)
    assert forces.pair.line_of_action == pytest.approx(3976.30, abs=5e-3)
    assert forces.normal == forces.half.normal == pytest.approx(2252.2, abs=0.05)
    assert forces.half.axial == pytest.approx(1058.2, abs=0.05)
    assert forces.pair.axial == 0.0
    assert forces.half.tangential_working == pytest.approx(0.5 * 3665.7, abs=0.05)
    assert pair.mesh_frequency(1000.0 * math.pi / 30.0) == pytest.approx(450.0)


def test_thesis_pair_stiffness():
    stiffness = gear_pair(THESIS).iso6336_stiffness()
    assert stiffness.theoretical_single == pytest.approx(18.7738e9, abs=5e4)
    assert stiffness.single == pytest.approx(12.682e9, abs=5e5)
    assert stiffness.mesh_alpha == pytest.approx(16.509e9, abs=5e5)
    assert stiffness.normal == pytest.approx(2.004e9, abs=5e5)
    low = gear_pair(THESIS).iso6336_stiffness(tangential_force=3665.7)
    assert low.single / stiffness.single == pytest.approx((38.75 / 100.0) ** 0.25, rel=1e-4)


def test_thesis_pair_bodies_and_shafts():
    pair = gear_pair(THESIS)
    pinion, wheel = pair.half_body
    assert (pinion.mass, wheel.mass) == pytest.approx((6.500, 47.739), abs=5e-4)
    assert pinion.inertia == pytest.approx(7.380e-3, abs=5e-7)
    assert wheel.inertia == pytest.approx(0.5813, abs=5e-5)
    pinion, wheel = pair.gap_shaft
    assert (pinion.axial, wheel.axial) == pytest.approx((1.671e10, 1.732e11), rel=3e-4)
    assert (pinion.radial, wheel.radial) == pytest.approx((4.192e9, 5.774e10), rel=1.5e-4)
    assert (pinion.torsional, wheel.torsional) == pytest.approx((7.637e6, 8.220e8), rel=7e-5)


def test_fzg_gears():
    """FZG type C, Hoehn, Oster and Michaelis: contact ratio, base pitch, tips, path of contact."""
    pair = gear_pair(SPUR)
    assert pair.transverse_contact_ratio == pytest.approx(1.46, abs=5e-3)
    assert 1e3 * pair.transverse_base_pitch == pytest.approx(13.285, abs=5e-4)
    assert [1e3 * r for r in pair.tip_radius] == pytest.approx((41.318, 59.272), abs=5.1e-4)
    assert 1e3 * pair.length_of_path_of_contact == pytest.approx(19.43, abs=5e-3)
    assert abs(pair.normal_backlash) < 1e-6


def test_nrel_stage_stiffness():
    """Fixture of the open Drivetrain code for stage 3 of the NREL 5 MW gearbox, all its digits."""
    stiffness = gear_pair(HELICAL).iso6336_stiffness()
    assert stiffness.theoretical_single == pytest.approx(20.051822093657e9, rel=1e-13)
    assert stiffness.single == pytest.approx(15.402808090687e9, rel=1e-13)


def test_forces_at_both_circles():
    """A commercial program's report of the NREL 5 MW stage 3 at 40953 N m, in newtons."""
    forces = gear_pair(HELICAL).tooth_forces(40953.0).pair
    assert forces.tangential_reference == pytest.approx(240064.4, rel=2e-6)
    assert forces.radial_reference == pytest.approx(88724.2, rel=2e-6)
    assert forces.axial == pytest.approx(42329.8, rel=2e-6)
    assert forces.normal == pytest.approx(259412.2, rel=2e-6)
    assert forces.tangential_working == pytest.approx(235840.3, rel=2e-6)
    assert forces.radial_working == pytest.approx(99409.4, rel=2e-6)
