"""Answers of a part that pulsate as its shaft turns, as means over a period of the turn.

Ripple and cogging of a motor repeat after a whole turn, mostly after a part of one: its torque
never settles, but the mean over a period does, and that is what balances a load. The period is the
longest of those after which the answers repeat, and of which a quarter of a trial holds two.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.cosim.structure.approach import Approach

_TURN = 2.0 * np.pi
POINT = _TURN / 480.0
"""Angle between points that are looked at [rad]."""
_PARTS = range(1, 49)
"""Of a whole turn, that may be a period."""
_ROOM = 2.0
_ALIKE = 0.95
"""Correlation of what pulsates with itself some periods before: sizes may change, as where it meets
a natural frequency while shafts speed up."""
_EVEN = 0.25
"""Its means over a period, over its size, at most: a slow motion is none that pulsates."""


class Shaft(NamedTuple):
    """How a shaft turns at the start of the run: speed [rad/s], acceleration [rad/s^2]."""

    speed: float
    acceleration: float

    def angles(self, times: np.ndarray) -> np.ndarray:
        """(k,) angles [rad] at times [s], in the second half of an approach."""
        return self.speed * times + 0.5 * self.acceleration * times * times


class Means(NamedTuple):
    """What answers come to over a period.

    Attributes:
        path: (k, m) means over the last period; NaN where none has passed.
        last: (m,) at the end, about it.
        pulsation: (m,) half of the range about the means.
    """

    path: np.ndarray
    last: np.ndarray
    pulsation: np.ndarray


def shafts_of(given: Approach) -> list[Shaft]:
    """Shafts among inputs that turn, each motion once."""
    turning = [Shaft(u.rate, u.acceleration) for u in given.inputs if u.begin is None]
    turning += [Shaft(u.value, u.rate) for u in given.inputs if u.moves]
    return [shaft for shaft in dict.fromkeys(turning) if shaft.speed]


def turns_of(shafts: Sequence[Shaft], duration: float) -> float:
    """Turns of the slowest shaft in the last quarter of a trial [s]; infinite if none turns."""
    found = (abs(shaft.speed) * 0.25 * duration / _TURN for shaft in shafts)
    return min(found, default=math.inf)


def means(shafts: Sequence[Shaft], times: np.ndarray, path: np.ndarray) -> Means | None:
    """Answers (k, m) at times (k,) of the second half of a trial, as means over a period.

    None if they do not repeat with the turn of a shaft, or a quarter is shorter than two periods.
    """
    for shaft in shafts:
        along = np.sign(shaft.speed) * shaft.angles(times)
        room = along[-1] - along[len(along) // 2]
        if np.any(np.diff(along) < 0.0):
            continue
        for period in (_TURN / part for part in _PARTS):
            if room < _ROOM * period:
                continue
            found = _over(period, along, path)
            late = (path - found)[len(path) // 2 :]
            if _pulsates(period, along, path - found):
                last, before = found[-1], _at(along[-1:] - period, along, found)[0]
                return Means(found, 1.5 * last - 0.5 * before, 0.5 * np.ptp(late, axis=0))
    return None


def _over(period: float, along: np.ndarray, path: np.ndarray) -> np.ndarray:
    """(k, m) means over the last period [rad]."""
    pieces = 0.5 * (path[1:] + path[:-1]) * np.diff(along)[:, None]
    whole = np.vstack([np.zeros(path.shape[1]), np.cumsum(pieces, axis=0)])
    return (whole - _at(along - period, along, whole)) / period


def _pulsates(period: float, along: np.ndarray, off: np.ndarray) -> bool:
    """If what is off the means (k, m) repeats in the second half, and is even over a period."""
    off = off - np.nanmean(off[len(off) // 2 :], axis=0)
    room = along[-1] - along[len(along) // 2]
    late = off[len(off) // 2 :]
    size = np.linalg.norm(late)
    for lag in (period, period * max(1.0, room // (_ROOM * period))):
        before = _at(along - lag, along, off)[len(off) // 2 :]
        if not np.sum(late * before) >= _ALIKE * size * np.linalg.norm(before):
            return False
    slow = _over(period, along, np.nan_to_num(off))[len(off) // 2 :]
    return bool(np.linalg.norm(slow) <= _EVEN * size)


def _at(places: np.ndarray, along: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(n, m) of values (k, m) at places (n,); NaN before the first."""
    return np.array([np.interp(places, along, column, left=np.nan) for column in values.T]).T
