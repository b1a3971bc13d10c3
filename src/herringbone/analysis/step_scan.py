"""Unstable bands of a macro step, by a scan of the spectral radius.

Stability is not monotone in the step, so that a bisection alone would jump over bands. A coarse
scan finds the first unstable step; a fine one goes from half of it to three times of it, or until
nothing has been stable for long; crossings are refined by bisection. Bands narrower than the
spacing of the fine scan (2.5 %) can be missed, and so can those far below the first coarse hit.
"""

from collections.abc import Callable

import numpy as np

from herringbone.analysis.amplification import GROWTH
from herringbone.core import HerringboneError, ParameterError

SMALLEST_STEP, LARGEST_STEP = 1e-6, 2e-3
"""Range of the scan [s]."""
_COARSE, _FINE = 1.10, 1.025
_BELOW, _ABOVE = 0.5, 3.0
_CLEARLY, _FOR_LONG = 1.2, 1.3
_RESOLUTION = 1.005
_NEAR = 0.85


def unstable_bands(
    radius: Callable[[float], float],
    smallest: float = SMALLEST_STEP,
    largest: float = LARGEST_STEP,
) -> tuple[tuple[float, float], ...]:
    """Unstable bands (from, to) [s] of a spectral radius over the steps of a range [s]."""
    coarse = _find_unstable(radius, smallest, _COARSE, largest)
    if coarse is None:
        return ()
    # The smallest step may be unstable itself: then nothing is looked for below.
    step = max(smallest, _BELOW * coarse)
    bands: list[tuple[float, float]] = []
    since: float | None = None
    before, end = step / _FINE, min(_ABOVE * coarse, largest)
    while step <= end:
        value = _safe(radius, step)
        bad = value > 1.0 + GROWTH
        if bad and since is None:
            since = step if step == smallest else _crossing(radius, before, step)
        elif not bad and since is not None:
            bands.append((since, _crossing(radius, before, step)))
            since = None
        if since is not None and value > _CLEARLY and step > _FOR_LONG * since:
            break
        before, step = step, step * _FINE
    if since is not None:
        bands.append((since, np.inf))
    return tuple(bands)


def _safe(radius: Callable[[float], float], step: float) -> float:
    """Spectral radius; infinite where a part fails within one step."""
    try:
        return radius(step)
    except ParameterError:
        raise
    except HerringboneError:
        return np.inf


def _unstable(radius: Callable[[float], float], step: float) -> bool:
    return _safe(radius, step) > 1.0 + GROWTH


def _find_unstable(
    radius: Callable[[float], float], step: float, factor: float, largest: float = LARGEST_STEP
) -> float | None:
    """First unstable step of a geometric sequence."""
    while step <= largest:
        if _unstable(radius, step):
            return step
        step *= factor
    return None


def _crossing(radius: Callable[[float], float], low: float, high: float) -> float:
    """Step between two of which one is stable, by bisection; the stable side of the bracket."""
    low_bad = _unstable(radius, low)
    while high > _RESOLUTION * low:
        middle = float(np.sqrt(low * high))
        if _unstable(radius, middle) == low_bad:
            low = middle
        else:
            high = middle
    return high if low_bad else low


def first_unstable_near(radius: Callable[[float], float], limit: float) -> float:
    """First unstable step near a known one [s]."""
    low = _NEAR * limit
    while low > SMALLEST_STEP and _unstable(radius, low):
        low *= _NEAR
    high = _find_unstable(radius, low * _FINE, _FINE)
    return np.inf if high is None else _crossing(radius, high / _FINE, high)
