"""What a table of limits does not say: of slow growth, and of steps between those looked at."""

import math
from collections.abc import Iterator, Sequence

from herringbone.analysis.stability.amplification import OWN
from herringbone.analysis.stability.growth import RIGID
from herringbone.analysis.stability.steps.step_limits import StepLimits
from herringbone.analysis.stability.steps.step_scan import LARGEST_STEP

_MICRO = 1e6
_SCHEDULE = ",schedule=bodies_first"
"""The default, left out of names."""


def in_us(step: float, largest: float = LARGEST_STEP) -> str:
    """A step [s] in microseconds; where there is none, that there is none up to the largest [s]."""
    return f"{_MICRO * step:.1f}" if math.isfinite(step) else f"> {_MICRO * largest:.0f}"


def short(algorithm: str) -> str:
    """The name of an algorithm without what is so by default."""
    return algorithm.removesuffix(_SCHEDULE)


def said_of_limits(limits: Sequence[StepLimits]) -> Iterator[str]:
    """Lines on limits, each of all algorithms of which it is true."""
    finite = [found for found in limits if math.isfinite(found.limit)]
    if between := [
        f"{short(found.algorithm)} {in_us(found.below)} to {in_us(found.limit)} us"
        for found in finite
        if found.steps
    ]:
        yield (
            "promised up to the first of two steps, unstable at the second one; between them "
            f"nothing is known, as parts have clocks: {', '.join(between)}"
        )
    if slow := [
        f"{short(found.algorithm)} in {found.limit / RIGID:.2g} s at its limit"
        for found in finite
        if found.frequency == 0.0 and found.own == 0.0
    ]:
        yield (
            f"at 0 Hz the rotation of shafts grows, by a power of e in {1.0 / RIGID:.0f} steps "
            f"({', '.join(slow)}); more slowly it grows below, which counts as stable"
        )
    own = max((found.own for found in limits), default=0.0)
    if own > OWN:
        yield (
            f"a slow motion grows by exp({own:.2g} t/s) whatever the step: the system itself does, "
            "and no step helps"
        )
    elif own > 0.0:
        yield (
            f"a slow motion grows by exp({own:.2g} t/s) whatever the step, as inner steps of parts "
            f"make it; up to exp({OWN:g} t/s) no step is blamed for that"
        )
