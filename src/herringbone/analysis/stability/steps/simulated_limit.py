"""The first unstable macro step as runs show it, near the predicted one.

A step is unstable if a small perturbation of a run grows (see `perturbed_run`). Stability is not
monotone in the step: steps are tried upwards, in the middle of predicted bands too, and only the
interval before the first unstable one is halved.
"""

import math
from collections.abc import Callable, Sequence

from herringbone.analysis.stability.linear_parts import NO_STRANGERS, Strangers, real_parts
from herringbone.analysis.stability.steps.perturbed_run import perturbation_growth
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.structure.system import System

LOWEST, HIGHEST = 0.5, 2.0
"""Range of steps that are tried, over the predicted limit."""
_DURATION, _FEWEST, _MOST = 0.5, 1000, 12500
_START, _FACTOR, _RESOLUTION = 0.9, 1.04, 1.01

Bands = Sequence[tuple[float, float]]


def nonlinear_limit(
    system: System,
    algorithm: Algorithm,
    predicted: float,
    bands: Bands = (),
    strangers: Strangers = NO_STRANGERS,
    grid: Sequence[float] = (),
) -> float | None:
    """First macro step [s] at which runs of the non-linear parts are unstable, to 1 %.

    Args:
        system: as it is started.
        algorithm: coupling algorithm.
        predicted: limit of the linear parts [s].
        bands: predicted unstable steps (from, to) [s].
        strangers: its foreign parts.
        grid: steps [s] that go with their clocks, ascending; the limit is one of these.

    Returns:
        A step between half the predicted limit and twice of it; None if runs are stable, or
        unstable, all the way, or if there is no finite prediction.
    """

    def unstable(step: float) -> bool:
        steps = run_steps(predicted)
        growth = perturbation_growth(
            system, lambda: real_parts(system, strangers), algorithm, step, steps=steps
        )
        return growth > 0.0

    if grid:
        near = [step for step in grid if LOWEST * predicted <= step <= HIGHEST * predicted]
        return next(filter(unstable, near), None)
    return first_unstable(unstable, predicted, bands)


def run_steps(near: float) -> int:
    """Macro steps of a run that is to tell of steps near a given one [s].

    Growth is seen from about 1.8 / steps, 0.014 to 0.18 % per step: the smaller the step, the more
    slowly an unstable motion grows from step to step, and the cheaper is one.
    """
    return int(min(max(_DURATION / near, _FEWEST), _MOST))


def first_unstable(
    unstable: Callable[[float], bool], predicted: float, bands: Bands = (), highest: float = HIGHEST
) -> float | None:
    """First unstable step [s], to 1 %, looked for around a predicted one.

    Args:
        unstable: tells of a step.
        predicted: limit [s].
        bands: predicted unstable steps (from, to) [s], whose middles are tried.
        highest: step that is tried last, over the predicted limit.

    Returns:
        The step; None if none is unstable, if all are, or if the prediction is not finite.
    """
    if not math.isfinite(predicted):
        return None
    low = _START * predicted
    while unstable(low):
        low /= _FACTOR
        if low < LOWEST * predicted:
            return None
    middles = [math.sqrt(a * b) for a, b in bands if math.isfinite(b)]
    tried = low
    while tried < highest * predicted:
        following = _FACTOR * tried
        tried = min([following, *(m for m in middles if tried < m < following)])
        if unstable(tried):
            return _refined(unstable, low, tried)
        low = tried
    return None


def _refined(unstable: Callable[[float], bool], low: float, high: float) -> float:
    """Step between a stable and an unstable one at which they change sides."""
    while high > _RESOLUTION * low:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if unstable(middle) else (middle, high)
    return math.sqrt(low * high)
