"""Steps that go with clocks: the last stable one and the first unstable one are known, no other."""

import numpy as np
import pytest

from herringbone.analysis.stability.growth import RIGID, Growth
from herringbone.analysis.stability.limit_lines import said_of_limits
from herringbone.analysis.stability.steps.clock_grid import bands_on_grid, stability_on_grid
from herringbone.analysis.stability.steps.step_limits import StepLimits
from herringbone.core import HerringboneError

PERIOD = 1e-3


class Clock:
    """A part that ticks every millisecond, and refuses steps below some length in s."""

    period = PERIOD

    def __init__(self, shortest=0.0):
        self.shortest = shortest

    def parts_of_period(self, h):
        if h < PERIOD and abs(PERIOD / h - round(PERIOD / h)) > 1e-6:
            raise HerringboneError("no map")
        return max(1, round(PERIOD / h))

    def takes(self, h):
        return h >= self.shortest


def growing_from(limit):
    return lambda step: Growth(1.1 if step >= limit else 0.9, 100.0, 0.0)


@pytest.mark.parametrize(
    ("limit", "below", "first"),
    [(0.7e-3, 0.5e-3, 1e-3), (15e-6, 12.5e-6, 15.625e-6), (2.5e-6, 2e-6, 2.5e-6)],
)
def test_neighbours_of_a_limit(limit, below, first):
    """Steps shorter than a fortieth of a period are looked at where that is unstable."""
    stable = stability_on_grid(growing_from(limit), [Clock()], 2e-3)
    assert max(step for step, is_stable in stable.items() if is_stable) == pytest.approx(below)
    ((low, high),) = bands_on_grid(stable)
    assert (low, high) == (pytest.approx(first), np.inf)


def test_no_shorter_step_than_one_that_is_stable():
    stable = stability_on_grid(growing_from(0.7e-3), [Clock()], 2e-3)
    assert min(stable) == PERIOD / 40
    stable = stability_on_grid(growing_from(15e-6), [Clock()], 2e-3)
    assert min(stable) == PERIOD / 80


def test_a_part_that_refuses_short_steps():
    stable = stability_on_grid(growing_from(1e-6), [Clock(shortest=1e-4)], 2e-3)
    assert not any(stable.values()) and min(stable) == PERIOD / 10


def limits(name, limit, **others):
    return StepLimits(name, ((limit, np.inf),), {"mean": limit}, **({"frequency": 50.0} | others))


def test_what_lines_say():
    gap = limits("li", 1e-3, steps=15, below=5e-4)
    (line,) = said_of_limits([gap])
    assert "li 500.0 to 1000.0 us" in line
    slow = limits("jacobi:order=0,schedule=bodies_first", 13e-6, frequency=0.0)
    (line,) = said_of_limits([slow])
    assert f"jacobi:order=0 in {13e-6 / RIGID:.2g} s" in line
    (line,) = said_of_limits([limits("li", 1e-3, own=0.08)])
    assert "exp(0.08 t/s) whatever the step, as inner steps" in line
    (line,) = said_of_limits([limits("li", 1e-3, own=3.0)])
    assert "exp(3 t/s) whatever the step: the system itself" in line
    assert not list(said_of_limits([limits("li", 1e-3)]))
