"""A pair under load: transmission error and the halves' stiffness, from a table and from slices."""

import math

import numpy as np
import pytest
from support.gearing.gears import SPUR, THESIS, gear_pair

from herringbone.core import ParameterError
from herringbone.gears.load.loaded_pair import Symmetry, loaded_pair, over_torque
from herringbone.gears.load.table_law import TableLaw
from herringbone.gears.stiffness.load_sharing import RIGID, load_sharing
from herringbone.gears.stiffness.slices import SliceMesh

PAIR = gear_pair(THESIS)
MESH = SliceMesh(PAIR, calibration=0.88)
LOAD = PAIR.tooth_forces(200.0).normal
TABLE = MESH.solve([0.0, *(LOAD * np.geomspace(0.05, 25.0, 10))], 64)
COSINE, SINE = math.cos(PAIR.base_helix_angle), math.sin(PAIR.base_helix_angle)


@pytest.mark.parametrize("torque", [30.0, 200.0, 1700.0])
def test_alike_halves(torque):
    """Deflection over cos(beta_b), solved at this very load: cubic between loads twice apart."""
    exact = MESH.solve([PAIR.tooth_forces(torque).normal], 64)
    found = loaded_pair(TABLE, torque)
    error = exact.transmission_error[0]
    assert found.transmission_error == pytest.approx(error, rel=1e-4)
    assert found.peak_to_peak == pytest.approx(np.ptp(error), rel=2e-3)
    assert len(found.halves) == 2
    assert found.share_left == pytest.approx(0.5)
    assert found.halves[1].secant == pytest.approx(exact.secant[0], rel=1e-4)


def test_single_half():
    """A spur pair carries all on one half: twice the error of two halves of its width."""
    pair = gear_pair(SPUR)
    table = SliceMesh(pair).solve([0.0, 1e3, 2e3, 4e3], 64)
    found = loaded_pair(table, 2e3 * pair.base_radius[0])
    assert len(found.halves) == 1
    assert found.share_left == 1.0
    assert found.transmission_error == pytest.approx(table.deflection[2], rel=1e-9)


@pytest.mark.parametrize("axial", [0.0, 1e8, RIGID])
def test_symmetry_deviation(axial):
    """The table's law gives what the slices give, at every phase."""
    found = loaded_pair(TABLE, 600.0, Symmetry(7e-6, axial))
    exact = load_sharing(MESH, 600.0, 7e-6, pinion_axial_stiffness=axial, phases=64)
    force = exact.force_left + exact.force_right
    left, right = found.halves
    assert left.force / force == pytest.approx(exact.force_left / force, abs=5e-4)
    for half in found.halves:
        assert MESH.law(half.phases)(half.deflection)[0] == pytest.approx(half.force, rel=5e-4)
    assert left.secant == pytest.approx(exact.secant_left, rel=1e-3)
    assert right.secant == pytest.approx(exact.secant_right, rel=1e-3)
    assert found.transmission_error == pytest.approx(exact.approach / COSINE, rel=1e-3)
    assert found.peak_to_peak == pytest.approx(np.ptp(exact.approach) / COSINE, rel=1e-2)


def test_one_half_carries_all():
    """Rigid pinion, 20 um: delta_L(F_L = 2 F) is known, the other half is u = sin(beta_b) f_A off.

    The approach is delta_L - u; lines of the left half are f_A tan(beta_b) / p_bt ahead.
    """
    found = loaded_pair(TABLE, 200.0, Symmetry(20e-6, RIGID))
    shift = 20e-6 * math.tan(PAIR.base_helix_angle) / PAIR.transverse_base_pitch
    for half, sign in zip(found.halves, (1.0, -1.0), strict=True):
        assert half.phases - found.phases == pytest.approx(np.full(64, sign * shift), abs=1e-15)
    law = MESH.law(found.phases + shift)
    deflection = COSINE * found.transmission_error + SINE * 20e-6
    assert law(deflection)[0] == pytest.approx(np.full(64, 2.0 * LOAD), rel=5e-4)
    assert np.all(found.halves[1].secant == 0.0)
    assert found.share_left == 1.0


def test_floating_pinion_hides_the_deviation():
    """The pinion goes where the halves share alike; lines of the halves are 0.18 % apart."""
    plain, found = loaded_pair(TABLE, 200.0), loaded_pair(TABLE, 200.0, Symmetry(20e-6))
    assert found.axial_shift.mean() == pytest.approx(-20e-6, rel=1e-3)
    assert found.transmission_error == pytest.approx(plain.transmission_error, rel=1e-3)


def test_over_torque():
    """The torques of the table's loads; with a deviation one half may have to carry all."""
    pairs = over_torque(TABLE)
    assert [p.torque for p in pairs] == pytest.approx(200.0 * np.geomspace(0.05, 25.0, 10))
    errors = [p.peak_to_peak for p in pairs]
    assert errors == pytest.approx(np.ptp(TABLE.transmission_error[1:], axis=1), rel=1e-6)
    held = over_torque(TABLE, Symmetry(10e-6, RIGID))
    assert max(p.torque for p in held) <= 2500.0
    assert all(p.share_left > 0.5 for p in held)


def test_law_of_a_table():
    """Near the slices, also below the first load; the tangent is the force's derivative."""
    phases = np.array([0.01, 0.37, 0.72])
    table, exact = TableLaw(TABLE).law(phases), MESH.law(phases)
    for depth, tolerance in ((0.1e-6, 5e-3), (1e-6, 3e-4), (7e-6, 3e-4)):
        here = np.full(3, depth)
        assert table(here)[0] == pytest.approx(exact(here)[0], rel=tolerance)
        slope = (table(here + 1e-10)[0] - table(here - 1e-10)[0]) / 2e-10
        assert table(here)[1] == pytest.approx(slope, rel=1e-5)
    assert not table(np.full(3, -1e-6))[0].any()
    far = TABLE.deflection[-1].max() + np.array([1e-6, 3e-6])
    rise = (table(np.full(3, far[1]))[0] - table(np.full(3, far[0]))[0]) / 2e-6
    assert rise == pytest.approx(table(np.full(3, far[0]))[1], rel=1e-9)


def test_deviation_needs_two_halves():
    pair = gear_pair(SPUR)
    with pytest.raises(ParameterError, match="double-helical"):
        loaded_pair(SliceMesh(pair).solve([0.0, 1e3], 8), 10.0, Symmetry(1e-6))
