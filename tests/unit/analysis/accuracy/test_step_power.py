"""Powers and errors of results that are C h^p apart from the truth, by arithmetic."""

import math

import pytest

from herringbone.analysis.accuracy.step_power import HIGHEST, left, left_of, step_power

STEPS = (8e-3, 2e-3, 5e-4)


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0, 4.0])
def test_power_and_error(power):
    errors = [3.0 * h**power for h in STEPS]
    first, second = errors[0] - errors[1], errors[1] - errors[2]
    assert step_power(first, second, STEPS) == pytest.approx(power, rel=1e-9)
    assert second * left_of(STEPS[1], STEPS[2], power) == pytest.approx(errors[2], rel=1e-12)


def test_differences_that_do_not_fall():
    assert step_power(1e-3, 1.1e-3, STEPS) == 0.0


def test_differences_without_bound_have_no_power():
    """As of a channel that does not change in one of both runs."""
    assert step_power(math.inf, math.inf, STEPS) == 0.0
    assert step_power(1e-3, math.inf, STEPS) == 0.0
    assert left(math.inf, math.inf, STEPS).error == math.inf


def test_runs_that_are_equal():
    assert step_power(1e-3, 0.0, STEPS) == HIGHEST
    assert step_power(0.0, 0.0, STEPS) == 0.0


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0, 4.0])
def test_what_is_left_of_three_runs(power):
    errors = [3.0 * h**power for h in STEPS]
    found = left(errors[0] - errors[1], errors[1] - errors[2], STEPS, power)
    assert found.error == pytest.approx(errors[2], rel=1e-9)
    assert found.power == found.counted == pytest.approx(power, rel=1e-9)


def test_more_than_the_fourth_power_is_not_believed():
    """Of an error of sixth order (8 ms to 2 ms) that becomes one of second order (to 0.5 ms)."""
    found = left(1e-3, 1e-3 / 4.0**6, STEPS, 6.0)
    assert found.power == pytest.approx(6.0, rel=1e-9)
    assert found.error == pytest.approx(1e-3 / 4.0**6 / 255.0, rel=1e-9)


def test_two_runs_or_distant_ones_tell_the_first_power():
    assert left(None, 3e-3, STEPS[:2]).error == pytest.approx(1e-3, rel=1e-9)
    assert left(5.0, 0.9, STEPS).error == pytest.approx(0.3, rel=1e-9)
    assert left(0.4, 3e-3, STEPS).counted == 2.0


def test_a_power_that_one_run_shows_counts_as_the_second():
    errors = [3.0 * h**4 for h in STEPS]
    first, second = errors[0] - errors[1], errors[1] - errors[2]
    assert left(first, second, STEPS).error == pytest.approx(second / 15.0, rel=1e-9)
    assert left(first, second, STEPS, 3.0).error == pytest.approx(second / 63.0, rel=1e-9)
