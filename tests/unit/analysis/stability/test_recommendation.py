"""The recommended algorithm and step, in closed form: rule, order, passes, margin and floor."""

import math

import pytest

from herringbone.analysis.stability.recommendation import (
    CHARTED_MICRO_STEP,
    CONTACT_ERROR,
    MARGIN,
    SEPARATION_ERROR,
    contact_floor,
    rank,
    separation_floor,
)
from herringbone.core import ParameterError
from herringbone.cosim.algorithms import ALGORITHMS, LI, Jacobi, with_tolerance
from herringbone.cosim.tolerance import SMALLEST_TOLERANCE, check_tolerance

JACOBI, CUBIC = Jacobi(2), LI(3)
FREQUENCY = 1e4
"""Of the bonds [rad/s]."""
JACOBI_STEP, LI_STEP = (a.accurate_step / FREQUENCY for a in (JACOBI, CUBIC))
"""At 0.1 %, by the rule [s]."""


def recommend(*arguments, **more):
    """The best of the ranked."""
    return rank(*arguments, **more).best


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-5])
@pytest.mark.parametrize(
    ("algorithm", "at_rule", "order"), [(JACOBI, JACOBI_STEP, 3), (CUBIC, LI_STEP, 4)]
)
def test_step_follows_the_order(algorithm, at_rule, order, tolerance):
    found = recommend([(algorithm, math.inf)], FREQUENCY, tolerance)
    assert found.algorithm == str(algorithm)
    assert found.step**order == pytest.approx(at_rule**order * tolerance / 1e-3, rel=1e-12)
    assert found.expected_error == pytest.approx(tolerance, rel=1e-12)
    floor = separation_floor(min(found.step, CHARTED_MICRO_STEP))
    bent = 1e-3 * (found.step / at_rule) ** 3  # forces bend between nodes
    assert found.separation_error == pytest.approx(max(tolerance, bent, floor), rel=1e-12)
    assert found.bounded_by == "accuracy"


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-5])
def test_li_steps_ten_times_as_far_with_two_passes(tolerance):
    limits = [(JACOBI, math.inf), (CUBIC, math.inf)]
    assert recommend(limits, FREQUENCY, tolerance).algorithm == str(CUBIC)
    assert recommend(limits[::-1], FREQUENCY, tolerance).algorithm == str(CUBIC)


@pytest.mark.parametrize(("times", "chosen"), [(1.9, JACOBI), (2.1, CUBIC)])
def test_two_passes_cost_twice(times, chosen):
    """`li` repeats each step: it has to step more than twice as far as `jacobi`."""
    limits = [(JACOBI, math.inf), (CUBIC, times * JACOBI_STEP / MARGIN)]
    assert recommend(limits, FREQUENCY, 1e-3).algorithm == str(chosen)


def test_step_within_a_margin_of_stability():
    """At half the accurate step the error of order 3 is an eighth."""
    found = recommend([(JACOBI, 0.5 * JACOBI_STEP / MARGIN)], FREQUENCY, 1e-3)
    assert found.step == pytest.approx(0.5 * JACOBI_STEP, rel=1e-12)
    assert found.expected_error == pytest.approx(1e-3 / 8.0, rel=1e-12)
    assert found.bounded_by == "stability"


@pytest.mark.parametrize("tolerance", [1e-8, 4e-8])
def test_no_promise_below_the_error_of_micro_steps(tolerance):
    """A smaller macro step would be in vain."""
    found = recommend([(CUBIC, math.inf)], FREQUENCY, tolerance)
    assert found.expected_error == pytest.approx(CONTACT_ERROR, rel=1e-12)
    assert found.bounded_by == "micro steps"
    assert found.step**4 == pytest.approx(LI_STEP**4 * CONTACT_ERROR / 1e-3, rel=1e-12)
    bent = 1e-3 * (CONTACT_ERROR / 1e-3) ** 0.75
    assert found.separation_error == pytest.approx(max(bent, SEPARATION_ERROR), rel=1e-12)


def test_no_promise_below_the_floor_with_a_stable_step_either():
    found = recommend([(CUBIC, 0.05 * LI_STEP / MARGIN)], FREQUENCY, 1e-3)
    assert found.step > CHARTED_MICRO_STEP
    assert (found.expected_error, found.bounded_by) == (CONTACT_ERROR, "stability")


def test_floors_follow_the_micro_step():
    """Classical Runge-Kutta in contact, a kink inside a micro step where teeth separate.

    Measured: 1.4e-6, 6.6e-6, 7.5e-5 with 2.5, 5 and 10 us (`tests/campaigns/inner_steps.py`).
    """
    assert contact_floor(5e-6) == pytest.approx(16.0 * CONTACT_ERROR, rel=1e-12)
    assert separation_floor(5e-6) == pytest.approx(8.0 * SEPARATION_ERROR, rel=1e-12)
    assert contact_floor(1e-9) == separation_floor(1e-9) == SMALLEST_TOLERANCE
    found = recommend([(CUBIC, math.inf)], FREQUENCY, 1e-7, micro_step=5e-6)
    assert found.expected_error == pytest.approx(contact_floor(5e-6), rel=1e-12)
    assert found.bounded_by == "micro steps"


def test_a_macro_step_cuts_micro_steps_shorter():
    """The gear steps no further than its inputs are given, whatever its own limit is."""
    found = recommend([(JACOBI, math.inf)], FREQUENCY, 1e-5, micro_step=20e-6)
    assert found.step < 3e-6
    assert (found.expected_error, found.bounded_by) == (pytest.approx(1e-5), "accuracy")


def test_nothing_without_a_rule_or_a_bond():
    assert recommend([(Jacobi(0), 1e-3)], FREQUENCY, 1e-3) is None
    assert recommend([(JACOBI, 1e-3)], 0.0, 1e-3) is None


def test_every_algorithm_is_ranked_or_named():
    """Cheapest first; what is left out is named with the reason."""
    limits = [(a, math.inf) for kind in ALGORITHMS.values() for a in kind.charted()]
    found = rank(limits, FREQUENCY, 1e-3)
    assert {*found.unranked, *(r.algorithm for r in found.ranked)} == {str(a) for a, _ in limits}
    assert len(found.ranked) + len(found.unranked) == len(limits)
    calls = [a.passes * 1e-3 * FREQUENCY / a.accurate_step for a, _ in limits if a.accurate_step]
    assert [r.passes_per_ms for r in found.ranked] == pytest.approx(sorted(calls), rel=1e-12)
    assert found.unranked == {str(Jacobi(0)): "no step at which it errs 0.1 % is known"}
    without_bond = rank(limits, 0.0, 1e-3)
    assert without_bond.ranked == () and without_bond.best is None
    assert set(without_bond.unranked) == {str(a) for a, _ in limits}
    assert "no bond" in without_bond.unranked[str(CUBIC)]


@pytest.mark.parametrize("tolerance", [1e-12, 0.0, 1.0, -1e-3, math.nan])
def test_tolerances_that_nothing_keeps(tolerance):
    with pytest.raises(ParameterError, match=r"^tolerance = .*: it must lie between 1e-08 and 1$"):
        check_tolerance(tolerance)
    with pytest.raises(ParameterError, match=r"^li: tolerance=.*; it must lie between 1e-08 and 1"):
        with_tolerance(LI(), tolerance)
