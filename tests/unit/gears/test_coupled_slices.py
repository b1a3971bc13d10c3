"""Slices that support each other along the face: their limits."""

import numpy as np
import pytest
from support.gears import SPUR, THESIS, gear_pair

from herringbone.core import ParameterError
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.slices import SliceMesh

LOADS = [0.0, 1e3, 2e4]


def test_spur_gear_does_not_feel_the_coupling():
    """All its slices deflect alike, ends included: the influence has a unit integral."""
    pair = gear_pair(SPUR)
    plain = SliceMesh(pair, calibration=0.9).solve(LOADS, 16)
    for coupling in (0.5, 2.5, 20.0):
        coupled = CoupledSliceMesh(pair, calibration=0.9, coupling=coupling).solve(LOADS, 16)
        np.testing.assert_allclose(coupled.secant, plain.secant, rtol=2e-3)
        np.testing.assert_allclose(coupled.tangent, plain.tangent, rtol=2e-3)


def test_short_coupling_is_the_slice_method():
    """The error goes with the length: 0.4 and 0.2 modules."""
    pair = gear_pair(THESIS)
    plain = SliceMesh(pair).solve([2e4], 4)
    errors = [
        np.abs(CoupledSliceMesh(pair, coupling=c).solve([2e4], 4).secant / plain.secant - 1).max()
        for c in (0.4, 0.2)
    ]
    assert errors[1] < 0.6 * errors[0] < 0.04


def test_relief_and_crowning_take_load_off_the_ends():
    """The deflection at a vanishing load is the least gap, the stiffness there zero."""
    pair = gear_pair(THESIS)
    modification = Modification(tip_relief=(5e-6, 5e-6), helix_crowning=4e-6)
    mesh = CoupledSliceMesh(pair, modification, slices=60)
    found = mesh.solve([0.0, 1.0, 2e4], 8)
    assert np.all(found.tangent[0] == 0.0)
    plain = CoupledSliceMesh(pair, slices=60).solve([2e4], 8)
    assert np.all(found.secant[2] < plain.secant[0])
    ends = [mesh.points(0.0), CoupledSliceMesh(pair, slices=60).points(0.0)]
    assert ends[0].gap.max() > 4e-6 > ends[1].gap.max()


def test_coupling_must_be_positive():
    with pytest.raises(ParameterError, match="coupling length 0 modules must be positive"):
        CoupledSliceMesh(gear_pair(SPUR), coupling=0.0)
