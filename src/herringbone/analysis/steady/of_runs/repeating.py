"""The times after which records may repeat, where no gear pair tells them.

What the records are off from themselves some rows earlier has deep minima there.
"""

from collections.abc import Sequence

import numpy as np

_DEEPEST, _MOST = 32, 16
"""Deepest minima that are looked at, and as many of the first ones; how many of these are told."""
_SHARE = 4.0
"""Depth of minima that are told, over that of the deepest one."""
_SHORTEST, _FINER = 4, 8
"""Records in a period, and lags between two records."""
_EXACT, _ROWS = 1e-4, 2000
"""How exact a time is, over the step of the records, and how many of them tell it at most."""


def repeating(
    values: np.ndarray, time: np.ndarray, groups: Sequence[Sequence[int]], tolerance: float
) -> list[float]:
    """Times [s] of at most half of the records, the shortest first.

    Args:
        values: (records, outputs).
        time: of the records [s], equidistant.
        groups: columns that are weighed together.
        tolerance: share of the alternating part of each group that need not repeat.
    """
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)
    from scipy.optimize import minimize_scalar  # noqa: PLC0415 (lazy)

    weighed = _weighed(values, groups)
    if not weighed.any():
        return []
    spline, step = CubicSpline(time, weighed), float(time[1] - time[0])

    def off(lag: float) -> float:
        later = time[time >= time[0] + lag]
        later = later[:: -(-later.size // _ROWS)]
        return float(np.square(spline(later) - spline(later - lag)).mean())

    def deepest(lag: float) -> tuple[float, float]:
        aside = step / _FINER
        best = minimize_scalar(
            off, bounds=(lag - aside, lag + aside), method="bounded",
            options={"xatol": _EXACT * step},
        )  # fmt: skip
        return float(best.x), float(best.fun)

    found = [deepest(lag * step) for lag in _lags(_mismatches(weighed))]
    exact = np.square(tolerance) / weighed.shape[1]
    most = _SHARE * max(min((depth for _, depth in found), default=0.0), exact)
    told = [period for period, depth in found if depth <= most][:_MOST]
    half = 0.5 * float(time[-1] - time[0])
    several = [max(1, int(half / period)) for period in told]  # these tell it more exactly
    return [deepest(n * period)[0] / n for n, period in zip(several, told, strict=True)]


def _weighed(values: np.ndarray, groups: Sequence[Sequence[int]]) -> np.ndarray:
    """Alternating parts (records, columns) of groups that have one, over that of the group."""
    found = [np.zeros((len(values), 0))]
    for own in groups:
        alternating = values[:, own] - values[:, own].mean(axis=0)
        size = float(np.sqrt(alternating.var(axis=0).sum()))
        if size > 0.0:
            found.append(alternating / size)
    return np.hstack(found)


def _mismatches(values: np.ndarray) -> np.ndarray:
    """(lags,) mean square of values (rows, n) less those a lag earlier, up to half of the rows."""
    rows = len(values)
    spectra = np.fft.rfft(values, 2 * rows, axis=0)
    power = np.square(np.abs(spectra)).sum(axis=1)
    lags = np.arange(_FINER * (rows // 2) + 1) / _FINER
    products = _FINER * np.fft.irfft(power, 2 * rows * _FINER)[: lags.size]
    own = np.concatenate([[0.0], np.cumsum(np.square(values).sum(axis=1))])
    ends = np.arange(rows + 1)
    later, earlier = own[-1] - np.interp(lags, ends, own), np.interp(rows - lags, ends, own)
    return (later + earlier - 2.0 * products) / ((rows - lags) * values.shape[1])


def _lags(mismatches: np.ndarray) -> np.ndarray:
    """Where the deepest minima are, over the step of the records, ascending.

    Depths are of parabolas, and no more exact than what the ends of the records make of them: up to
    that the first ones are among them.
    """
    left, own, right = mismatches[:-2], mismatches[1:-1], mismatches[2:]
    at = np.flatnonzero((own <= left) & (own < right))
    at = at[at >= _SHORTEST * _FINER]
    left, own, right = left[at], own[at], right[at]
    depths = own - np.square(right - left) / (8.0 * (left - 2.0 * own + right))
    doubt = mismatches.max() * _FINER / mismatches.size
    first = np.flatnonzero(depths <= depths.min(initial=np.inf) + doubt)[:_DEEPEST]
    chosen = np.union1d(first, np.argsort(depths)[:_DEEPEST])
    lags: np.ndarray = (at[chosen] + 1) / _FINER
    return lags
