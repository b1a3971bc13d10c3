"""Load and contact pressure on the flank: balance, ISO 6336-2, symmetry."""

import math

import numpy as np
import pytest
from support.gearing.gears import HELICAL, SPUR, THESIS, gear_pair

from herringbone.gears.finite_elements import FiniteElementMesh
from herringbone.gears.finite_elements.blocks import Resolution
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.load.flank_load import (
    axial_position,
    contact_pressure,
    flank_load,
    relative_curvature,
)
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.slices import SliceMesh

PHASES = np.arange(32) / 32
PAIR = gear_pair(THESIS)
LOAD = PAIR.tooth_forces(200.0).normal


def iso_6336_2(pair, force: float) -> float:
    """Z_H Z_E sqrt(F_t/(d_1 b) (u + 1)/u) [Pa]: nominal contact stress at the pitch point."""
    alpha_t, alpha_wt = pair.transverse_pressure_angle, pair.working_transverse_pressure_angle
    z_h = math.sqrt(
        2.0 * math.cos(pair.base_helix_angle) * math.cos(alpha_wt)
        / (math.cos(alpha_t) ** 2 * math.sin(alpha_wt))
    )  # fmt: skip
    z_e = math.sqrt(pair.youngs_modulus / (2.0 * math.pi * (1.0 - pair.poissons_ratio**2)))
    assert 1e-3 * z_e == pytest.approx(189.8, abs=0.05)
    u = pair.gear_ratio
    return (
        z_h
        * z_e
        * math.sqrt(force / (2.0 * pair.reference_radius[0] * pair.face_width) * (u + 1.0) / u)
    )


def test_spur_pair_at_the_pitch_point():
    """One pair of teeth in contact: the contact stress of ISO 6336-2 with Z_epsilon 1."""
    pair = gear_pair(SPUR)
    forces = pair.tooth_forces(200.0)
    found = flank_load(SliceMesh(pair), pair, PHASES, np.full(32, forces.normal))
    pitch = pair.path_of_contact.pitch - pair.path_of_contact.start
    middle = [np.interp(pitch, found.path, column) for column in found.pressure.T]
    expected = iso_6336_2(pair, forces.pair.tangential_reference)
    assert middle == pytest.approx(np.full(found.face.size, expected), rel=1e-4)
    assert found.largest_line_load == pytest.approx(forces.normal / pair.face_width, rel=1e-9)


def test_published_contact_stress():
    """570.79 MPa in a commercial program's report: Z_epsilon 0.827, Z_beta 1.008, evenly loaded.

    Printed factors of three digits: 1e-3.
    """
    pair = gear_pair(HELICAL, tip_alteration_coefficient=-0.938 / 14.0)
    forces = pair.tooth_forces(40953.0)
    length = pair.face_width * pair.transverse_contact_ratio / math.cos(pair.base_helix_angle)
    pitch = pair.path_of_contact.pitch - pair.path_of_contact.start
    even = float(contact_pressure(pair, np.array(pitch), np.array(forces.normal / length)))
    assert 1e-6 * even * 1.008 == pytest.approx(570.79, rel=1e-3)
    exact = iso_6336_2(pair, forces.pair.tangential_reference)
    assert even == pytest.approx(exact / math.sqrt(pair.transverse_contact_ratio), rel=1e-12)


@pytest.mark.parametrize("phase", [0.0, 0.43])
@pytest.mark.parametrize("relief", [0.0, 8e-6])
def test_loads_of_every_method_carry_the_force(phase, relief):
    modification = Modification((relief, relief), 3e-3, helix_crowning=0.5 * relief)
    coarse = Resolution(4, 2, 1, 4)
    for mesh in (
        SliceMesh(PAIR, modification),
        CoupledSliceMesh(PAIR, modification, slices=60),
        FiniteElementMesh(gear_pair(SPUR), resolution=coarse),
    ):
        line = mesh.line_load(phase, LOAD)
        assert np.sum(line.load * line.length) == pytest.approx(LOAD, rel=1e-8)
        assert line.load.min() >= 0.0
        assert not mesh.line_load(phase, 0.0).load.any()


def test_map_holds_the_mean_load():
    """The mean of the map over path and face, times the mean length of line, is the force.

    Lines of b epsilon_alpha / cos(beta_b) pass over the flank; strips and bins: 1 %.
    """
    found = flank_load(SliceMesh(PAIR), PAIR, PHASES, np.full(32, LOAD))
    length = PAIR.face_width * PAIR.transverse_contact_ratio / math.cos(PAIR.base_helix_angle)
    mean = np.trapezoid(found.line_load.mean(axis=1), found.path) / found.path[-1]
    assert mean * length == pytest.approx(LOAD, rel=0.01)
    assert found.largest_pressure == pytest.approx(found.pressure.max(), rel=0.01)
    assert found.line_load.shape == (found.path.size, found.face.size)


def test_relief_takes_the_load_off_the_ends():
    """Of the path (tips) and of the face (crowning); the middle takes it."""
    modification = Modification((8e-6, 8e-6), 3e-3, helix_crowning=5e-6)
    plain, relieved = (
        flank_load(mesh, PAIR, PHASES, np.full(32, LOAD))
        for mesh in (SliceMesh(PAIR), SliceMesh(PAIR, modification))
    )
    rows, columns = plain.path.size, plain.face.size
    for at in ((0, columns // 2), (-1, columns // 2), (rows // 2, 0), (rows // 2, -1)):
        assert relieved.line_load[at] < 0.3 * plain.line_load[at]
    middle = rows // 2, columns // 2
    assert relieved.line_load[middle] > 1.1 * plain.line_load[middle]


def test_few_slices():
    """Strips of the face are as many as there are points of whole slices for."""
    for slices, columns in ((120, 48), (30, 24)):
        found = flank_load(SliceMesh(PAIR, slices=slices), PAIR, PHASES, np.full(32, LOAD))
        assert found.face.size == columns
    single = flank_load(SliceMesh(PAIR, slices=1), PAIR, PHASES, np.full(32, LOAD))
    assert np.all(np.isfinite(single.pressure))


@pytest.mark.parametrize("model", [SliceMesh, CoupledSliceMesh])
def test_largest_pressure_does_not_depend_on_the_slices(model):
    modification = Modification((5e-6, 5e-6), 3e-3, helix_crowning=3e-6)
    found = [
        flank_load(model(PAIR, modification, slices=slices), PAIR, PHASES, np.full(32, LOAD))
        for slices in (60, 120)
    ]
    largest = [flank.largest_pressure for flank in found]
    assert largest[0] == pytest.approx(largest[1], rel=5e-3)


def test_corner_contact_is_not_on_the_map():
    """Corners before and behind the path take load off its ends; the map has none of theirs."""
    plain, corner = (
        flank_load(mesh, PAIR, PHASES, np.full(32, LOAD))
        for mesh in (SliceMesh(PAIR), SliceMesh(PAIR, corner_contact=True))
    )
    assert corner.line_load[0].max() < plain.line_load[0].mean()
    assert corner.line_load[0].min() > 0.9 * plain.line_load[0].min()


def test_curvature_at_the_pitch_point():
    """r_b1 tan(alpha_wt) u / (u + 1) / cos(beta_b)."""
    pitch = PAIR.path_of_contact.pitch - PAIR.path_of_contact.start
    reach = PAIR.base_radius[0] * math.tan(PAIR.working_transverse_pressure_angle)
    expected = reach * 3.0 / 4.0 / math.cos(PAIR.base_helix_angle)
    assert float(relative_curvature(PAIR, np.array(pitch))) == pytest.approx(expected, rel=1e-12)


def test_where_the_halves_lie():
    """Positive helix angle of the left half: its lines run ahead at the gap, 22.5 mm off middle."""
    face = np.array([0.0, PAIR.face_width])
    assert axial_position(PAIR, 0, face) == pytest.approx((69.8e-3, 22.5e-3))
    assert axial_position(PAIR, 1, face) == pytest.approx((-69.8e-3, -22.5e-3))
    other = gear_pair(THESIS, helix_angle=-PAIR.helix_angle)
    assert axial_position(other, 0, face) == pytest.approx((22.5e-3, 69.8e-3))
