"""Contact of tip corners and meshing impact: the figures of an independent derivation."""

import math

import numpy as np
import pytest
from support.gearing.gears import THESIS, gear_pair

from herringbone.core import ParameterError
from herringbone.gears.geometry.corner_contact import corner_separation, meshing_impact
from herringbone.gears.stiffness.slices import SliceMesh

PAIR = gear_pair(THESIS, bore_diameter=(0.040, 0.090))
CONSTANT_PAIR = 5.73e8
"""Stiffness of one pair over the full face [N/m], with constant contact compliance."""


def test_separation_rises_with_the_square():
    """S = 10.7 s^2 at the entry, 8.8 s^2 at the exit."""
    for gear, curvature in ((1, 10.7), (0, 8.8)):
        distance = np.array([1e-4, 2e-4])
        separation = corner_separation(PAIR, gear, distance)
        assert separation / distance**2 == pytest.approx([curvature] * 2, abs=0.06)
        assert corner_separation(PAIR, gear, np.zeros(1))[0] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(
    ("torque", "speed", "velocity", "force"),
    [
        (200.0, 800.0, 0.043, 1649.0),
        (200.0, 1000.0, 0.053, 2061.0),
        (200.0, 1500.0, 0.080, 3092.0),
        (250.0, 1000.0, 0.059, 2296.0),
        (300.0, 800.0, 0.052, 2007.0),
        (300.0, 1500.0, 0.097, 3762.0),
    ],
)
def test_impact_of_the_thesis_pair(torque, speed, velocity, force):
    """v_s and F_s; the figures use S = 10.7 s^2, the program the exact separation (1.5 % more)."""
    deflection = SliceMesh(PAIR).solve([PAIR.tooth_forces(torque).normal]).deflection.mean()
    impact = meshing_impact(PAIR, speed * math.pi / 30.0, deflection, CONSTANT_PAIR)
    assert impact.velocity == pytest.approx(velocity, rel=0.025)
    assert impact.force == pytest.approx(force, rel=0.015)


def test_early_contact():
    """0.54 mm at 200 N m, 4.6 % of the base pitch; proportional to the speed."""
    deflection = SliceMesh(PAIR).solve([PAIR.tooth_forces(200.0).normal]).deflection.mean()
    slow = meshing_impact(PAIR, 50.0, deflection, CONSTANT_PAIR)
    fast = meshing_impact(PAIR, 100.0, deflection, CONSTANT_PAIR)
    assert 1e3 * slow.early_contact == pytest.approx(0.54, abs=0.01)
    assert slow.early_contact / PAIR.transverse_base_pitch == pytest.approx(0.046, abs=1e-3)
    assert fast.force == pytest.approx(2.0 * slow.force, rel=1e-12)


def test_stiffness_of_one_pair():
    mesh = SliceMesh(PAIR, hertz="yang-sun")
    assert mesh.single_pair_stiffness(1.0) == pytest.approx(CONSTANT_PAIR, rel=2e-3)


@pytest.mark.parametrize(("torque", "rise", "second"), [(200.0, 3.2, 0.33), (2000.0, 9.7, None)])
def test_corner_contact_raises_the_stiffness(torque, rise, second):
    """Mean +3.2 % at 200 N m, +9.7 % at 2000 N m; the second harmonic from 0.67 to 0.33 %."""
    loads = [PAIR.tooth_forces(torque).normal]
    plain = SliceMesh(PAIR, hertz="yang-sun").solve(loads)
    corner = SliceMesh(PAIR, hertz="yang-sun", corner_contact=True).solve(loads)
    change = corner.secant.mean() / plain.secant.mean() - 1.0
    assert 100.0 * change == pytest.approx(rise, abs=0.2)
    if second is not None:
        assert 100.0 * plain.harmonics()[0, 1] == pytest.approx(0.67, abs=0.03)
        assert 100.0 * corner.harmonics()[0, 1] == pytest.approx(second, abs=0.02)


def test_impact_of_a_load_that_is_too_large():
    with pytest.raises(ParameterError, match="a base pitch early"):
        meshing_impact(PAIR, 100.0, 5e-3, CONSTANT_PAIR)
