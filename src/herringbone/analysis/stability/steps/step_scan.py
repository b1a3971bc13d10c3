"""Unstable bands of a macro step, by a scan of the spectral radius.

Stability is not monotone in the step, so that a bisection alone would jump over bands. A coarse
scan finds an unstable step; a fine one goes from a quarter of it to twice of it, in longer steps
where motions grow clearly or none is near half the rate of communication points, or until nothing
has been stable for long. Close to the first unstable step, where a run is most likely to be asked
for, steps follow each other as closely as motions that come to half the rate ask for (below): so a
band in which one of them meets its mirror image, or another one's, is seen however narrow it is,
down to 0.5 %. Edges of bands are refined by bisection.

Narrow bands open where two motions meet on the unit circle, above all where a motion at half the
rate of communication points meets its own mirror image. With the decay d per step of the motion
alone and the growth g per step in the band, the band has a relative width of
(2 / pi) sqrt(g (2 d + g)): with d = 1 %, growth by 0.1 % makes a band 0.3 % wide. But the two
eigenvalues are real over a width of at least 2 d / pi around it, where their radius rises: maxima
of it, and of the radius of all fast motions, are searched between the steps of the scan. What can
still be missed are bands of motions with a damping ratio below 1.3 %, bands below a quarter of the
first coarse hit, and gaps between bands far beyond the first one.
"""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from herringbone.analysis.stability.growth import GROWTH, Growth
from herringbone.core import HerringboneError, ParameterError

SMALLEST_STEP, LARGEST_STEP = 1e-6, 2e-3
"""Range of the scan [s]."""
COARSE, _FINE = 1.25, 1.025
"""Factors between steps of the scans."""
_WIDEST = 1.08
"""Factor of the fine scan where no motion is near half the rate; less than `NEAR_MIRROR`, within
which such motions are looked for."""
_BELOW, _ABOVE = 0.25, 2.0
_GROWING, _FINER_NO_MORE = 1.001, 1.05
"""Growth beyond which a scan looks for stable steps above a band, and its factor there."""
_CLEARLY, _FOR_LONG = 1.2, 1.3
_RESOLUTION, _EDGE = 1.005, 1.0025
"""Smallest factor between steps around a limit, and that between the sides of a band's edge."""
_CLOSELY = 1.05
_NEAR = 0.93
_CLOSE_TO_ONE = {"fast_radius": 0.97, "mirror_radius": 0.9}
_TRIES, _CLOSE = 7, 1e-3

GrowthOf = Callable[[float], Growth]
"""Growth at a macro step [s]; may raise HerringboneError where a part fails within one step."""


def unstable_bands(
    growth: GrowthOf,
    smallest: float = SMALLEST_STEP,
    largest: float = LARGEST_STEP,
    coarse: float = COARSE,
) -> tuple[tuple[float, float], ...]:
    """Unstable bands (from, to) [s] over the steps of a range [s].

    `to` is infinite if everything examined above `from` is unstable. The fine scan ends at twice
    the coarse one's first hit: above a finite last band steps are stable up to there, and nothing
    is known beyond.
    """
    first = _find_unstable(growth, smallest, coarse, largest)
    if first is None:
        return ()
    # The smallest step may be unstable itself: then nothing is looked for below.
    samples = _samples(growth, max(smallest, _BELOW * first), min(_ABOVE * first, largest))
    samples.append((first, safe_growth(growth, first)))
    samples = _with_maxima(growth, sorted(samples, key=_step))
    samples += _closely(growth, next(step for step, value in samples if _grows(value)))
    samples.sort(key=_step)
    bands: list[tuple[float, float]] = []
    since = samples[0][0] if _grows(samples[0][1]) else None
    for (before, _), (step, value) in pairwise(samples):
        if _grows(value) and since is None:
            since = _crossing(growth, before, step)
        elif not _grows(value) and since is not None:
            bands.append((since, _crossing(growth, before, step)))
            since = None
    if since is not None:
        bands.append((since, np.inf))
    return tuple(bands)


def first_unstable_near(growth: GrowthOf, limit: float, below: float = 1.0) -> float:
    """First unstable step near a known one [s]; closely around it narrow bands are seen, too.

    Args:
        growth: at a step.
        limit: the known one [s].
        below: factor by which it may lie lower for a reason that is known.
    """
    low = _NEAR * below * limit
    while low > SMALLEST_STEP and _grows(safe_growth(growth, low)):
        low *= _NEAR
    samples = _along(growth, low, limit / _NEAR, beyond=False)
    if _grows(samples[-1][1]):
        return _crossing(growth, *map(_step, samples[-2:])) if len(samples) > 1 else low
    high = _find_unstable(growth, limit / _NEAR, _FINE)
    return np.inf if high is None else _crossing(growth, high / _FINE, high)


def first_unstable(growth: GrowthOf, smallest: float, largest: float) -> float | None:
    """First unstable step of a range [s], on a coarse scan; None if there is none.

    Many times cheaper than all bands; a narrow one can be missed, but not just below what is found.
    """
    found = _find_unstable(growth, smallest, COARSE, largest)
    if found in {None, smallest}:
        return found
    return first_unstable_near(growth, _crossing(growth, found / COARSE, found))


def safe_growth(growth: GrowthOf, step: float) -> Growth:
    """Growth; infinite where a part fails within one step."""
    try:
        return growth(step)
    except ParameterError:
        raise
    except HerringboneError:
        return Growth(np.inf, np.nan, np.inf)


def _grows(value: Growth) -> bool:
    return value.radius > 1.0 + GROWTH


def _find_unstable(
    growth: GrowthOf, step: float, factor: float, largest: float = LARGEST_STEP
) -> float | None:
    """First unstable step of a geometric sequence, which ends with the largest step."""
    while not _grows(safe_growth(growth, step)):
        if step >= largest:
            return None
        step = min(step * factor, largest)
    return step


def _samples(growth: GrowthOf, first: float, end: float) -> list[tuple[float, Growth]]:
    """Growth on the fine grid, which is wider where no motion comes to half the rate.

    It ends early where nothing has been stable for long.
    """
    found: list[tuple[float, Growth]] = []
    step, since = first, np.inf
    while step <= end:
        value = safe_growth(growth, step)
        found.append((step, value))
        since = min(since, step) if _grows(value) else np.inf
        if value.radius > _CLEARLY and step > _FOR_LONG * since:
            break
        step *= _FINER_NO_MORE if value.radius > _GROWING else _apart(value, _FINE, _WIDEST)
    return found


def _closely(growth: GrowthOf, first: float) -> list[tuple[float, Growth]]:
    """Growth around the first unstable step, at the resolution of the crossings."""
    return _along(growth, first / _CLOSELY, first * _CLOSELY)


def _along(
    growth: GrowthOf, low: float, high: float, *, beyond: bool = True
) -> list[tuple[float, Growth]]:
    """Growth at steps so close together that no motion meets its mirror image between them.

    Without `beyond` none above the first unstable one.
    """
    found = [(low, safe_growth(growth, low))]
    while found[-1][0] < high and (beyond or not _grows(found[-1][1])):
        step, value = found[-1]
        step = min(step * _apart(value, _RESOLUTION, _FINE), high)
        found.append((step, safe_growth(growth, step)))
    return _with_maxima(growth, found)


def _apart(value: Growth, least: float, most: float) -> float:
    """Factor to the next step: half of that over which two motions stay together, within bounds."""
    decay = max(0.0, 1.0 - value.near_mirror)
    return float(np.clip(1.0 + decay / np.pi, least, most))


def _step(sample: tuple[float, Growth]) -> float:
    return sample[0]


def _with_maxima(
    growth: GrowthOf, samples: list[tuple[float, Growth]]
) -> list[tuple[float, Growth]]:
    """The samples, and the steps tried for a maximum wherever a radius comes close to 1.

    Not where the radius of fast motions rises because a slow one has become one of them.
    """
    found = list(samples)
    for (low, one), (middle, top), (high, other) in zip(
        samples, samples[1:], samples[2:], strict=False
    ):
        for radius, close in _CLOSE_TO_ONE.items():
            before, here, after = (getattr(value, radius) for value in (one, top, other))
            joined = radius == "fast_radius" and top.was_slow(low / middle)
            is_top = close < here > max(before, after) and not joined
            if is_top and not any(map(_grows, (one, top, other))):
                found += _tries(growth, low, high, radius)
    return sorted(found, key=_step)


def _tries(growth: GrowthOf, low: float, high: float, radius: str) -> list[tuple[float, Growth]]:
    """Steps on the way to the largest value of a radius between two steps."""
    from scipy.optimize import minimize_scalar  # noqa: PLC0415 (lazy)

    tried = []

    def negative(step: float) -> float:
        tried.append((float(step), safe_growth(growth, float(step))))
        return -getattr(tried[-1][1], radius)

    options = {"maxiter": _TRIES, "xatol": _CLOSE * low}
    minimize_scalar(negative, bounds=(low, high), method="bounded", options=options)
    return tried


def _crossing(growth: GrowthOf, low: float, high: float) -> float:
    """Step between two of which one is stable, by bisection; the stable side of the bracket."""
    low_bad = _grows(safe_growth(growth, low))
    while high > _EDGE * low:
        middle = float(np.sqrt(low * high))
        if _grows(safe_growth(growth, middle)) == low_bad:
            low = middle
        else:
            high = middle
    return high if low_bad else low
