"""Unstable bands of a macro step, by a scan of the spectral radius.

Stability is not monotone in the step, so that a bisection alone would jump over bands. A coarse
scan finds an unstable step; a fine one goes from half of it to three times of it, or until nothing
has been stable for long. Between its steps, bands show as maxima of the radius of fast motions
close to 1: these are searched. Crossings are refined by bisection. What can still be missed are
bands below half of the first coarse hit, and bands so narrow that the radius 2.5 % away from them
does not rise.
"""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from scipy.optimize import minimize_scalar

from herringbone.analysis.amplification import GROWTH, Growth
from herringbone.core import HerringboneError, ParameterError

SMALLEST_STEP, LARGEST_STEP = 1e-6, 2e-3
"""Range of the scan [s]."""
_COARSE, _FINE = 1.25, 1.025
_BELOW, _ABOVE = 0.5, 3.0
_CLEARLY, _FOR_LONG = 1.2, 1.3
_RESOLUTION = 1.005
_NEAR = 0.85
_CLOSE_TO_ONE = 0.97
_TRIES, _CLOSE = 7, 1e-3

GrowthOf = Callable[[float], Growth]
"""Growth at a macro step [s]; may raise HerringboneError where a part fails within one step."""


def unstable_bands(
    growth: GrowthOf, smallest: float = SMALLEST_STEP, largest: float = LARGEST_STEP
) -> tuple[tuple[float, float], ...]:
    """Unstable bands (from, to) [s] over the steps of a range [s].

    The upper end of the last band is infinite: above it everything examined is unstable.
    """
    coarse = _find_unstable(growth, smallest, _COARSE, largest)
    if coarse is None:
        return ()
    # The smallest step may be unstable itself: then nothing is looked for below.
    samples = _samples(growth, max(smallest, _BELOW * coarse), min(_ABOVE * coarse, largest))
    samples = _with_maxima(growth, samples)
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


def first_unstable_near(growth: GrowthOf, limit: float) -> float:
    """First unstable step near a known one [s]."""
    low = _NEAR * limit
    while low > SMALLEST_STEP and _grows(_safe(growth, low)):
        low *= _NEAR
    high = _find_unstable(growth, low * _FINE, _FINE)
    return np.inf if high is None else _crossing(growth, high / _FINE, high)


def _safe(growth: GrowthOf, step: float) -> Growth:
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
    while not _grows(_safe(growth, step)):
        if step >= largest:
            return None
        step = min(step * factor, largest)
    return step


def _samples(growth: GrowthOf, first: float, end: float) -> list[tuple[float, Growth]]:
    """Growth on the fine grid; it ends early where nothing has been stable for long."""
    found: list[tuple[float, Growth]] = []
    step, since = first, np.inf
    while step <= end:
        value = _safe(growth, step)
        found.append((step, value))
        since = min(since, step) if _grows(value) else np.inf
        if value.radius > _CLEARLY and step > _FOR_LONG * since:
            break
        step *= _FINE
    return found


def _with_maxima(
    growth: GrowthOf, samples: list[tuple[float, Growth]]
) -> list[tuple[float, Growth]]:
    """The samples, and the steps tried for a maximum wherever the radius comes close to 1."""
    found = list(samples)
    for (low, one), (_, top), (high, other) in zip(samples, samples[1:], samples[2:], strict=False):
        peak = _CLOSE_TO_ONE < top.fast_radius > max(one.fast_radius, other.fast_radius)
        if peak and not any(map(_grows, (one, top, other))):
            found += _tries(growth, low, high)
    return sorted(found, key=lambda sample: sample[0])


def _tries(growth: GrowthOf, low: float, high: float) -> list[tuple[float, Growth]]:
    """Steps on the way to the largest radius of fast motions between two steps."""
    tried = []

    def fast(step: float) -> float:
        tried.append((float(step), _safe(growth, float(step))))
        return -tried[-1][1].fast_radius

    options = {"maxiter": _TRIES, "xatol": _CLOSE * low}
    minimize_scalar(fast, bounds=(low, high), method="bounded", options=options)
    return tried


def _crossing(growth: GrowthOf, low: float, high: float) -> float:
    """Step between two of which one is stable, by bisection; the stable side of the bracket."""
    low_bad = _grows(_safe(growth, low))
    while high > _RESOLUTION * low:
        middle = float(np.sqrt(low * high))
        if _grows(_safe(growth, middle)) == low_bad:
            low = middle
        else:
            high = middle
    return high if low_bad else low
