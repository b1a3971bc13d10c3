"""Macro steps that go with the clocks of foreign parts, and which of them are unstable.

Nothing is known of steps between these: a limit is a pair of neighbours, the last one that is
stable and the first one that is not.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from herringbone.analysis.stability.growth import GROWTH
from herringbone.analysis.stability.linear_parts import Strangers
from herringbone.analysis.stability.steps.step_scan import SMALLEST_STEP, GrowthOf, safe_growth
from herringbone.analysis.stability.surrogates.sampled import SampledSurrogate
from herringbone.core import HerringboneError

_SAME = 1e-6
"""Deviation from a whole period that is rounding."""
_PARTS = (40, 32, 25, 20, 16, 12, 10, 8, 6, 5, 4, 3, 2)
_FINER = (50, 64, 80, 100, 125, 160, 200, 250, 320, 400, 500, 640, 800, 1000)
_PERIODS = (
    *range(1, 17),
    *range(18, 33, 2),
    *range(36, 65, 4),
    *range(72, 129, 8),
    *range(144, 257, 16),
)
"""Parts and numbers of a period that are looked at as macro steps; the finer parts only until one
is stable."""


def clocks_of(strangers: Strangers) -> list[SampledSurrogate]:
    """What stands for parts with clocks."""
    found = (stranger.surrogate for stranger in strangers.values())
    return [surrogate for surrogate in found if isinstance(surrogate, SampledSurrogate)]


def common_steps(clocks: Sequence[SampledSurrogate], largest: float) -> list[float]:
    """Macro steps [s] up to a largest one of which all these parts have maps, ascending."""
    period = clocks[0].period
    wanted = sorted({*(period / n for n in _PARTS), *(period * n for n in _PERIODS)})
    longest = (1.0 + _SAME) * max(largest, period)
    return list(_taken(clocks, [step for step in wanted if step <= longest]))


def stability_on_grid(
    growth: GrowthOf, clocks: Sequence[SampledSurrogate], largest: float
) -> dict[float, bool]:
    """Macro steps [s] up to a largest one that go with clocks, ascending: True if it is stable.

    Where the shortest is unstable, shorter ones follow until one is stable.
    """

    def stable(step: float) -> bool:
        return safe_growth(growth, step).radius <= 1.0 + GROWTH

    found = {step: stable(step) for step in common_steps(clocks, largest)}
    if found and not found[min(found)]:
        finer = (clocks[0].period / n for n in _FINER)
        below = [step for step in finer if SMALLEST_STEP <= step < min(found)]
        for step in _taken(clocks, below):
            found[step] = stable(step)
            if found[step]:
                break
    return dict(sorted(found.items()))


def bands_on_grid(stable: dict[float, bool]) -> tuple[tuple[float, float], ...]:
    """Unstable bands (from, to) [s] among steps, by which of them are stable."""
    bands: list[tuple[float, float]] = []
    for (_, before), (step, now) in pairwise([(0.0, True), *stable.items()]):
        if before and not now:
            bands.append((step, np.inf))
        elif now and not before:
            bands[-1] = bands[-1][0], step
    return tuple(bands)


def _taken(clocks: Sequence[SampledSurrogate], steps: Sequence[float]) -> Iterator[float]:
    """Those of the steps of which all parts have maps, and that none refuses."""
    for step in steps:
        try:
            for clock in clocks:
                clock.parts_of_period(step)
        except HerringboneError:
            continue
        if all(clock.takes(step) for clock in clocks):
            yield step
