"""ISO 6336-1 method B: published examples, a hand calculation, the ranges of the speed."""

import math

import pytest
from support.gearing.gears import THESIS, gear_pair

from herringbone.core import ParameterError
from herringbone.gears import GearPair
from herringbone.gears.load.dynamic_factor import (
    Deviations,
    dynamic_factor,
    effective_deviations,
    reduced_mass,
)

RPM = math.pi / 30.0
EXAMPLE = GearPair(
    number_of_teeth=(17, 103),
    normal_module=8e-3,
    helix_angle=math.radians(15.8),
    face_width=0.1,
    halves=1,
    center_distance=0.5,
    profile_shift_coefficient=(0.145, 0.0),
    dedendum_coefficient=1.4,
    density=7830.0,
)
"""ISO/TR 6336-30, example 1; 9000 N m at 360 r/min."""
STAGE = GearPair(
    number_of_teeth=(24, 95),
    normal_module=14e-3,
    helix_angle=math.radians(10.0),
    face_width=0.36,
    halves=1,
    center_distance=0.861,
    profile_shift_coefficient=(0.48, 0.6691),
    tip_alteration_coefficient=-0.938 / 14.0,
    bore_diameter=(0.1791, 1.19332),
    density=7830.0,
)
"""NREL 5 MW, stage 3, as in the report of a commercial program (ISO 6336:2006, K_A 1.25)."""


def test_example_of_the_standard():
    """c', c_gamma_alpha and F_t of ISO/TR 6336-30, example 1."""
    stiffness = EXAMPLE.iso6336_stiffness()
    assert 1e-9 * stiffness.single == pytest.approx(12.3705, rel=2e-4)
    assert 1e-9 * stiffness.mesh_alpha == pytest.approx(17.465, rel=2e-4)
    forces = EXAMPLE.tooth_forces(9000.0)
    assert forces.pair.tangential_reference == pytest.approx(127352.0, abs=0.5)


def test_example_by_hand():
    """N and K_v at 9000 N m and 360 r/min, K_A 1, f_pb,eff 8 um, f_falpha,eff 10 um, C_a 70 um.

    In N, mm, um: d_a 159.6601/872.3548, d_f 121.2601/833.9548, d_b 132.1986/800.9678;
    d_m = 140.4601 and 853.1548; solid steel of 7.83e-6 kg/mm3:
      m_1 = pi/8 7.83e-6 140.4601^4/132.1986^2 = 0.0684826, m_2 = 2.539235
      m_red = 0.0684826 2.539235/(0.0684826 + 2.539235) = 0.0666841 kg/mm
    n_E1 = 30000/(pi 17) sqrt(17.467190/0.0666841) = 9091.23 r/min,  N = 0.0395986: subcritical
    w = 1273.5238 N/mm,  B_p = 12.370472 8/1273.5238 = 0.0777086,  B_f = 0.0971358,
    B_k = |1 - 12.370472 70/1273.5238| = 0.3200496
    epsilon_gamma 1.549342 + 1.083369 = 2.632711:
      C_v2 = 0.57/2.332711 = 0.2443509,  C_v3 = 0.096/1.072711 = 0.0894929
    K_v = 1 + 0.0395986 (0.32 0.0777086 + 0.2443509 0.0971358 + 0.0894929 0.3200496) = 1.0030588
    """
    found = dynamic_factor(EXAMPLE, 9000.0, 360.0 * RPM, Deviations(8e-6, 10e-6, 70e-6))
    assert 1e-3 * found.reduced_mass == pytest.approx(0.0666841, rel=1e-6)
    assert found.resonance_speed / RPM == pytest.approx(9091.23, rel=1e-6)
    assert found.resonance_ratio == pytest.approx(0.0395986, rel=1e-6)
    assert found.speed_range == "subcritical"
    effects = (found.pitch_effect, found.profile_effect, found.relief_effect)
    assert effects == pytest.approx((0.0777086, 0.0971358, 0.3200496), abs=1e-7)
    assert found.factor == pytest.approx(1.0030588, abs=1e-7)


def test_report_of_a_commercial_program():
    """Every printed digit: 40953 N m, 1165.9 r/min, f_pb 15.9 - 1.2 um, f_falpha 22 - 1.6 um.

    Class 6: the relief does not count.
    """
    assert 1e-3 * reduced_mass(STAGE) == pytest.approx(0.36503, abs=5e-6)
    found = dynamic_factor(
        STAGE, 40953.0, 1165.9 * RPM, Deviations(14.7e-6, 20.4e-6),
        load_factor=1.25, blank_factor=0.898,
    )  # fmt: skip
    assert 1e-3 * found.specific_load == pytest.approx(1.25 * 666.85, abs=0.01)
    assert found.resonance_speed / RPM == pytest.approx(2843.0, abs=0.5)
    assert found.resonance_ratio == pytest.approx(0.410, abs=5e-4)
    assert found.factor == pytest.approx(1.092, abs=5e-4)


def at(ratio: float, torque: float = 5000.0, data: dict | None = None) -> tuple[str, float]:
    pair = gear_pair(THESIS, **(data or {}))
    deviations = Deviations(6e-6, 7e-6)
    resonance = dynamic_factor(pair, torque, 1.0, deviations).resonance_speed
    found = dynamic_factor(pair, torque, ratio * resonance, deviations)
    return found.speed_range, found.factor


def test_ranges():
    """Linear from 1, constant in resonance, linear down to the constant above; ends meet."""
    names = [at(ratio)[0] for ratio in (0.5, 1.0, 1.3, 2.0)]
    assert names == ["subcritical", "main resonance", "intermediate", "supercritical"]
    assert at(0.8)[1] - 1.0 == pytest.approx(2.0 * (at(0.4)[1] - 1.0), rel=1e-12)
    assert at(0.9) == pytest.approx(at(1.1))
    ends = at(1.15)[1], at(1.5)[1]
    assert at(1.325)[1] == pytest.approx(0.5 * sum(ends), rel=1e-9)
    assert ends[0] > ends[1] == at(4.0)[1]
    assert at(1.15 + 1e-9)[1] == pytest.approx(ends[0], abs=1e-7)


def test_coefficients_at_other_contact_ratios():
    """Resonance: 1 + 0.32 B_p + 0.34 B_f + 0.9 with spur teeth; above 0.47 (B_p + B_f) + C_v7."""
    spur = {"helix_angle": 0.0, "groove_diameter": None}
    pair = gear_pair(THESIS, **spur)
    assert 1.5 < pair.total_contact_ratio < 2.0
    found = dynamic_factor(pair, 5000.0, 1.0, Deviations(6e-6, 7e-6))
    b_p, b_f = found.pitch_effect, found.profile_effect
    assert at(1.0, data=spur)[1] == pytest.approx(1.9 + 0.32 * b_p + 0.34 * b_f, rel=1e-12)
    last = 0.875 + 0.125 * math.sin(math.pi * (pair.total_contact_ratio - 2.0))
    assert at(2.0, data=spur)[1] == pytest.approx(last + 0.47 * (b_p + b_f), rel=1e-12)


def test_light_load_broadens_the_resonance():
    """200 N m are 38.75 N/mm over both halves: from 0.5 + 0.35 sqrt(0.3875) = 0.7179."""
    found = dynamic_factor(gear_pair(THESIS), 200.0, 100.0, Deviations(6e-6, 7e-6))
    assert 1e-3 * found.specific_load == pytest.approx(38.75, abs=5e-3)
    assert found.lower_limit == pytest.approx(0.7179, abs=5e-5)
    assert at(0.73, 200.0)[0] == "main resonance"


def test_deviations_of_a_class():
    """Class 6 of the wheel: 9.5 um cos(22.7959 deg) and 10 um, less 7.5 %; relief below 6."""
    pair = gear_pair(THESIS)
    found = effective_deviations(pair, 6, 5e-6)
    assert found.base_pitch == pytest.approx(0.925 * 9.5e-6 * 0.921887, rel=1e-5)
    assert found.profile_form == pytest.approx(0.925 * 10e-6, rel=1e-12)
    assert found.tip_relief is None
    assert effective_deviations(pair, 5, 5e-6).tip_relief == 5e-6
    coarse = effective_deviations(pair, 11)
    assert coarse.profile_form == pytest.approx(55e-6 - 3e-6)


@pytest.mark.parametrize(
    ("values", "message"),
    [((0.0, 1.0), "torque 0 N m"), ((1.0, -1.0), "speed -1 rad/s"), ((1.0, 1.0), "load factor 0")],
)
def test_bad_input(values, message):
    factor = 0.0 if "load" in message else 1.0
    with pytest.raises(ParameterError, match=message):
        dynamic_factor(EXAMPLE, *values, Deviations(1e-6, 1e-6), load_factor=factor)
