"""The degree of an adaptive run, against the quickest of fixed steps that keep the tolerance."""

import pytest

from herringbone.running.steps.cheapest_degree import cheapest_degree

RIG = 14312.0
"""Fastest bond of the test rig [rad/s]."""


@pytest.mark.parametrize(
    ("tolerance", "apart", "quickest"),
    [(1e-2, 1e-4, 3), (1e-3, 1e-4, 4), (1e-5, 1e-4, 4), (1e-3, 5e-5, 3)],
)
def test_the_quickest_of_fixed_steps_on_the_rig(tolerance, apart, quickest):
    """`loaded`: 100 us; 100 us, where degree 3 errs 1.02e-3; 50 us; 50 us."""
    assert cheapest_degree(RIG, tolerance, apart) == quickest


def test_where_teeth_part_degree_4_is_for_small_tolerances():
    assert [cheapest_degree(None, tolerance, 1e-4) for tolerance in (1e-3, 1e-4, 1e-5)] == [3, 3, 4]


def test_a_slow_bond_takes_the_largest_step_of_either_degree():
    """A tenth of the rig's: both degrees go from row to row in one step, and 3 is the cheaper."""
    assert cheapest_degree(0.1 * RIG, 1e-5, 1e-4) == 3
