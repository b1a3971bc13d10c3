"""Slices that support each other along the face: their limits."""

import itertools
import math

import numpy as np
import pytest
from support.gearing.gears import SPUR, THESIS, gear_pair

from herringbone.core import ParameterError
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.job import GearJob
from herringbone.gears.stiffness.coupled_slices import TILT, CoupledSliceMesh
from herringbone.gears.stiffness.slices import SliceMesh
from herringbone.gears.stiffness.tooth_compliance import tooth_compliance

LOADS = [0.0, 1e3, 2e4]


def test_spur_gear_does_not_feel_the_coupling():
    """All its slices deflect alike, ends included: the influence has a unit integral."""
    pair = gear_pair(SPUR)
    usual = CoupledSliceMesh(pair).solve(LOADS, 16)
    for lengths in ((0.5, 0.5), (2.5, 20.0)):
        other = CoupledSliceMesh(pair, lengths=lengths).solve(LOADS, 16)
        np.testing.assert_allclose(other.secant, usual.secant, rtol=2e-3)
        np.testing.assert_allclose(other.tangent, usual.tangent, rtol=2e-3)


def test_evenly_loaded_spur_tooth():
    """Its slices' compliance by parts, and the ring in shear by the torque: 1/h^2 - 1/r^2."""
    pair = gear_pair(SPUR)
    mesh = CoupledSliceMesh(pair, parts=(1.1, 0.7))
    line = mesh.lines.lines(0.3)[0]
    width, points = pair.face_width, pair.path_of_contact
    reach = (points.start + line[0][0], points.tangent_length - points.start - line[0][0])
    expected = 0.0
    for gear in range(2):
        base, root, hub = (
            getattr(pair, f"{name}_radius")[gear] for name in ("base", "root", "hub")
        )
        part = tooth_compliance(pair, gear, np.array([math.hypot(base, reach[gear])]), "strain")
        tooth, local = part.total - part.foundation, part.foundation - part.turning
        shear = pair.youngs_modulus / 2.6
        expected += (1.1 * tooth + 0.7 * local)[0] / width
        expected += base**2 * (1 / hub**2 - 1 / root**2) / (4 * math.pi * shear * width)
    even = np.full(line[1].size, 1.0 / line[1].size)
    np.testing.assert_allclose(mesh.compliance([line]) @ even, expected, rtol=2e-3)


def test_turning_is_what_goes_with_the_square_of_the_hub():
    """The polynomials have it smaller than the ring in plane shear, by up to a half."""
    found, ring = [], []
    for bore in (0.02, 0.03):
        pair = gear_pair(SPUR, bore_diameter=(bore, bore))
        tooth = tooth_compliance(pair, 1, np.array([pair.pitch_radius[1]]))
        found.append(tooth.turning[0])
        shear = pair.youngs_modulus / 2.6
        ring.append((pair.base_radius[1] / pair.hub_radius[1]) ** 2 / (4 * math.pi * shear))
        assert 0.5 * ring[-1] < found[-1] < min(ring[-1], tooth.foundation[0])
    assert found[0] / found[1] == pytest.approx(1.5**2, rel=1e-12)


def test_short_coupling_converges():
    """To slices without support; the error goes with the length: 0.4, 0.2 and 0.1 modules."""
    pair = gear_pair(THESIS)
    found = [
        CoupledSliceMesh(pair, lengths=(length, length)).solve([2e4], 4).secant
        for length in (0.4, 0.2, 0.1)
    ]
    steps = [np.abs(a / b - 1.0).max() for a, b in itertools.pairwise(found)]
    assert steps[1] < 0.6 * steps[0] < 0.02


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


def test_body_tilts_under_the_axial_force():
    """One tooth pair at a time, that of a narrow gear: its deflection grows by F times the term."""
    pair = gear_pair(THESIS, face_width=10e-3)
    mesh = CoupledSliceMesh(pair)
    _, face, _ = mesh.lines.lines(0.0)[0]
    bare = CoupledSliceMesh(pair, tilt=(0.0, 0.0))
    added = mesh.compliance(mesh.lines.lines(0.0)) - bare.compliance(bare.lines.lines(0.0))
    plate, shear = TILT
    expected = sum(
        plate * (root - hub) ** 2 / 10e-3**3 + shear * math.log(root / hub) / 10e-3
        for root, hub in zip(pair.root_radius, pair.hub_radius, strict=True)
    )
    expected *= math.sin(pair.base_helix_angle) ** 2 / pair.youngs_modulus
    own = slice(0, face.size)
    np.testing.assert_allclose(added[own, own], expected, rtol=1e-9)


def test_spur_gear_does_not_tilt():
    pair = gear_pair(SPUR)
    tilted, held = (CoupledSliceMesh(pair, tilt=tilt).solve(LOADS, 4) for tilt in (TILT, (0, 0)))
    assert np.array_equal(tilted.deflection, held.deflection)


@pytest.mark.parametrize("lengths", [(0.0, 6.0), (1.3, -1.0)])
def test_coupling_must_be_positive(lengths):
    with pytest.raises(ParameterError, match=r"coupling length of the .* modules must be positive"):
        CoupledSliceMesh(gear_pair(SPUR), lengths=lengths)


def test_contact_at_overloaded_ends_yields_no_further():
    """Its deflection load * secant rises up to the formula's limit, and stays."""
    lines = SliceMesh(gear_pair(THESIS))
    _, _, slices = lines.lines(0.0)[0]
    limit = np.exp(slices.logarithm - 1.0) - 100.0
    shares = np.array([0.5, 0.99, 1.0, 2.0, 50.0])
    deflection, tangent = np.array(
        [(share * limit * secant, slope) for share in shares
         for secant, slope in [lines.contact(slices, share * limit)]]
    ).swapaxes(0, 1)  # fmt: skip
    assert np.all(tangent >= 0.0)
    assert np.all(np.diff(deflection[:3], axis=0) > 0.0)
    np.testing.assert_allclose(deflection[3:], np.tile(deflection[2], (2, 1)), rtol=1e-12)


def test_table_of_a_pair_without_a_torque_reaches_overload():
    """At 25 times 100 N/mm the ends of the lines of module 3.5 mm are beyond the contact's formula.

    Far from there all follows as before: stiffness rises with the load at every phase.
    """
    pair = gear_pair(THESIS, number_of_teeth=(23, 57), face_width=40e-3, groove_diameter=None)
    found = CoupledSliceMesh(pair).solve(GearJob(pair).task().loads, 256)
    assert np.all(np.diff(found.secant, axis=0) > 0.0)


def test_load_that_no_teeth_can_carry():
    mesh = CoupledSliceMesh(gear_pair(THESIS), slices=60)
    with pytest.raises(ParameterError, match="presses the contact as wide"):
        mesh.solve([0.0, 1e9], 4)
