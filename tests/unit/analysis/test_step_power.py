"""Powers and errors of results that are C h^p apart from the truth, by arithmetic."""

import pytest

from herringbone.analysis.accuracy.step_power import HIGHEST, left_of, step_power

STEPS = (8e-3, 2e-3, 5e-4)


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0, 4.0])
def test_power_and_error(power):
    errors = [3.0 * h**power for h in STEPS]
    first, second = errors[0] - errors[1], errors[1] - errors[2]
    assert step_power(first, second, STEPS) == pytest.approx(power, rel=1e-9)
    assert second * left_of(STEPS[1], STEPS[2], power) == pytest.approx(errors[2], rel=1e-12)


def test_differences_that_do_not_fall():
    assert step_power(1e-3, 1.1e-3, STEPS) == 0.0


def test_runs_that_are_equal():
    assert step_power(1e-3, 0.0, STEPS) == HIGHEST
    assert step_power(0.0, 0.0, STEPS) == 0.0
