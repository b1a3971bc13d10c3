"""Stiffness tables with few harmonics of the mesh: what is kept, and that it is still one law."""

import numpy as np
import pytest
from support.gearing.deviating_teeth import PAIR, write_law, write_teeth

from herringbone.components.gear_mesh import layout as at
from herringbone.components.gear_mesh.harmonics import keep_harmonics
from herringbone.components.registry import COMPONENTS
from herringbone.core import Instance
from herringbone.gears.stiffness.slices import SliceMesh
from herringbone.kernels import force_law

_KEPT = 5
_PHASES = np.arange(force_law.PHASES) / force_law.PHASES
_DEPTHS = (2e-6, 9e-6)


def _gear(**values):
    instance = Instance(COMPONENTS["gear_mesh"], "gear_mesh")
    for name, value in values.items():
        instance.set(name, value)
    instance.initialise()
    return instance


def _forces(block, table, depth):
    return np.array([force_law.law(block, table, p, depth)[0] for p in _PHASES])


@pytest.mark.parametrize("table", at.TABLE)
@pytest.mark.parametrize("depth", _DEPTHS)
def test_the_force_has_these_harmonics_and_no_others(table, depth):
    whole = _gear().block
    few = whole.copy()
    assert keep_harmonics(few, _KEPT) == ""
    lines, kept = (np.fft.rfft(_forces(block, table, depth)) for block in (whole, few))
    assert abs(lines[_KEPT + 1]) > 1e-6 * abs(lines[0])  # there is something to leave out
    np.testing.assert_allclose(kept[: _KEPT + 1], lines[: _KEPT + 1], atol=1e-12 * abs(lines[0]))
    assert np.abs(kept[_KEPT + 1 :]).max() < 1e-12 * abs(lines[0])


def test_force_and_push_are_still_the_slopes_of_the_energy():
    """Central differences over 1e-4 of what varies: 1e-8 of the third derivative, and rounding."""
    block, table = _gear().block, at.TABLE[0]
    keep_harmonics(block, _KEPT)
    for depth in _DEPTHS:
        step, turn = 1e-4 * depth, 1e-5
        for phase in (0.123, 0.777):
            force, _, push = force_law.law(block, table, phase, depth)
            up, down = (
                force_law.energy(block, table, phase, depth + sign * step) for sign in (1.0, -1.0)
            )
            assert (up - down) / (2.0 * step) == pytest.approx(force, rel=1e-6)
            up, down = (
                force_law.energy(block, table, phase + sign * turn, depth) for sign in (1.0, -1.0)
            )
            assert (up - down) / (2.0 * turn) == pytest.approx(push, rel=1e-5, abs=1e-7 * up)


def test_all_harmonics_are_the_table_itself():
    whole = _gear().block
    every = whole.copy()
    assert keep_harmonics(every, force_law.PHASES) == ""
    np.testing.assert_allclose(every, whole, rtol=0.0, atol=1e-12 * np.abs(whole).max())


def test_teeth_that_deviate_have_no_table_to_shorten(tmp_path):
    law = write_law(tmp_path / "law.csv", SliceMesh(PAIR, slices=60))
    teeth = write_teeth(tmp_path / "teeth.csv", 6)
    block = _gear(pair_law=str(law), tooth_deviations=str(teeth)).block
    before = block.copy()
    assert "teeth that deviate" in keep_harmonics(block, _KEPT)
    np.testing.assert_array_equal(block, before)


def test_a_table_whose_contact_would_pull_is_left_as_it_is():
    """Teeth that stand apart over part of the period: a mean with one line falls below zero."""
    block = _gear().block
    for table in at.TABLE:
        nodes = block[table + 2 : table + force_law.TABLE_SIZE]
        nodes.reshape(force_law.PHASES, -1)[_PHASES > 0.1] *= 1e-3
    before = block.copy()
    assert "below zero" in keep_harmonics(block, 1)
    np.testing.assert_array_equal(block, before)
