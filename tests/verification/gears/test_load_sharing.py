"""Load sharing of the halves: the figures of an independent model, symmetry, balance."""

import math

import numpy as np
import pytest
from support.gearing.gears import SPUR, THESIS, gear_pair

from herringbone.core import ParameterError
from herringbone.gears.stiffness.load_sharing import RIGID, gap_shaft_compliance, load_sharing
from herringbone.gears.stiffness.slices import SliceMesh

PAIR = gear_pair(THESIS, bore_diameter=(0.040, 0.090))
MESH = SliceMesh(
    PAIR, calibration=0.8685, slices=60
)  # 2.011e9 N/m at 2000 N m, as the figures have
WHEEL_AXIAL = 2 * 2.03e8
RADIAL = 6.34e8


def share(torque: float, deviation: float, **axial: float) -> float:
    return load_sharing(MESH, torque, deviation, phases=8, **axial).share_left


@pytest.mark.parametrize(
    ("torque", "shares"),
    [
        (200.0, (0.701, 0.995, 1.000, 1.000)),
        (1000.0, (0.542, 0.606, 0.712, 0.922)),
        (2000.0, (0.522, 0.554, 0.609, 0.717)),
        (4000.0, (0.511, 0.528, 0.556, 0.611)),
    ],
)
def test_axially_rigid_pinion(torque, shares):
    """f_A 2, 5, 10, 20 um: 5 um already put the load of 200 N m on one half.

    The figures' calibration is on the whole compliance, not on that of the teeth: 0.002.
    """
    found = [
        share(torque, deviation, pinion_axial_stiffness=RIGID)
        for deviation in (2e-6, 5e-6, 10e-6, 20e-6)
    ]
    assert found == pytest.approx(shares, abs=2.5e-3)


@pytest.mark.parametrize(
    ("stiffness", "expected"),
    [(0.0, 0.5), (1e5, 0.5002), (1e6, 0.5023), (1e7, 0.5224), (1e8, 0.653), (1e9, 0.868)],
)
def test_axially_held_pinion(stiffness, expected):
    """200 N m, f_A 10 um, with the wheel's axial bearing and the gap shafts of the 12-DOF model."""
    found = share(
        200.0,
        10e-6,
        pinion_axial_stiffness=stiffness,
        wheel_axial_stiffness=WHEEL_AXIAL,
        shaft_compliance=gap_shaft_compliance(PAIR, RADIAL),
    )
    assert found == pytest.approx(expected, abs=2e-4 if stiffness < 1e8 else 1.5e-3)


def test_floating_pinion_takes_the_deviation():
    """F_L = F_R for any constant deviation; the pinion moves by -f_A but for the mesh's ripple."""
    found = load_sharing(MESH, 200.0, 20e-6)
    assert found.force_left == pytest.approx(found.force_right, rel=1e-8)
    assert found.axial_shift.mean() == pytest.approx(-20e-6, rel=1e-3)


def test_balance():
    """Forces carry the torque; the axial forces balance the springs; deflections are the law's."""
    found = load_sharing(
        MESH, 600.0, 7e-6, pinion_axial_stiffness=2e8, wheel_axial_stiffness=WHEEL_AXIAL
    )
    beta = PAIR.base_helix_angle
    total = 600.0 / (PAIR.base_radius[0] * math.cos(beta))
    assert found.force_left + found.force_right == pytest.approx(np.full(16, total), rel=1e-9)
    spring = 1.0 / (1.0 / 2e8 + 1.0 / WHEEL_AXIAL)
    axial = math.sin(beta) * (found.force_left - found.force_right)
    assert axial == pytest.approx(-spring * found.axial_shift, rel=1e-7)
    difference = found.deflection_left - found.deflection_right
    assert difference == pytest.approx(2.0 * math.sin(beta) * (found.axial_shift + 7e-6), rel=1e-7)


def test_other_sign_loads_the_other_half():
    for axial in (1e8, RIGID):
        plus = share(800.0, 6e-6, pinion_axial_stiffness=axial)
        minus = share(800.0, -6e-6, pinion_axial_stiffness=axial)
        assert plus == pytest.approx(1.0 - minus, abs=1e-9)
        assert plus > 0.5


def test_no_deviation_no_difference():
    for axial in (0.0, 1e8, RIGID):
        assert share(200.0, 0.0, pinion_axial_stiffness=axial) == pytest.approx(0.5, abs=1e-12)


def test_definitions_of_the_stiffness():
    """2000 N m, 20 um, rigid: which definition falls and which rises is what differs."""
    even = load_sharing(MESH, 2000.0, 0.0, pinion_axial_stiffness=RIGID)
    off = load_sharing(MESH, 2000.0, 20e-6, pinion_axial_stiffness=RIGID)
    assert even.stiffness_by_mean_approach == pytest.approx(2.011e9, rel=1e-3)
    assert off.stiffness_by_mean_approach == pytest.approx(2.017e9, rel=1e-3)
    assert off.stiffness_by_loaded_half == pytest.approx(1.42e9, rel=2e-3)
    assert off.stiffness_left == pytest.approx(1.018e9, rel=2e-3)
    assert off.stiffness_right == pytest.approx(0.986e9, rel=4e-3)


@pytest.mark.parametrize(
    ("mesh", "torque", "axial", "message"),
    [
        (SliceMesh(gear_pair(SPUR)), 10.0, {}, "double-helical"),
        (MESH, 0.0, {}, "torque 0 N m must be positive"),
        (MESH, 1.0, {"pinion_axial_stiffness": -1.0}, "-1 N/m of the pinion"),
        (MESH, 1.0, {"shaft_compliance": -1.0}, "shaft compliance -1 m/N"),
    ],
)
def test_bad_input(mesh, torque, axial, message):
    with pytest.raises(ParameterError, match=message):
        load_sharing(mesh, torque, 1e-6, **axial)


def test_the_other_hand_loads_the_other_half():
    """The sign of the helix angle is the hand of the left half, which mirrors the halves."""
    other = SliceMesh(gear_pair(THESIS, helix_angle=-PAIR.helix_angle), slices=30)
    one = SliceMesh(gear_pair(THESIS, helix_angle=PAIR.helix_angle), slices=30)
    held = {"pinion_axial_stiffness": 1e9, "phases": 8}
    left, right = (load_sharing(m, 200.0, 5e-6, **held).share_left for m in (one, other))
    assert left > 0.8
    assert right == pytest.approx(1.0 - left, abs=1e-3)
