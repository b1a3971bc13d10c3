"""Whether motions beside each other part: the largest Lyapunov exponent of the condensed core.

Two marches that differ by little go on together, and after each mesh the second one is put back to
the first distance (G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn, Meccanica 15, 1980,
9-20). A motion that parts from its neighbours never repeats, however long it is marched; one whose
neighbours come to it repeats with the gears, or is about to. They are compared where theta is the
same: being late neither grows nor dies out.
"""

import math
from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.orbit import Motion
from herringbone.analysis.steady.marching.period_map import PeriodMap
from herringbone.analysis.steady.structure import Structure

_APART, _LONGEST = 1e-5, 20e-6
"""Distance over the swing of the coordinates; base step [s]."""
_PLACES = 16
"""Of a mesh, at which swings are looked at."""
_AHEAD, _FEWEST = 16, 1024
"""Meshes over which swings are looked at, and first distances turn; meshes that tell, at least."""
_STANDS = 1e-9
"""Swing of a coordinate, over its size, that is none."""
_BEYOND = 2.0
"""Standard errors."""
_BLOCKS = 8
"""Parts of them whose means tell how far the whole is known."""


class Parting(NamedTuple):
    """How the distance of motions beside each other grows.

    Attributes:
        rate: logarithm of what it is multiplied by in a mesh period, in the mean.
        doubt: standard error of that.
    """

    rate: float
    doubt: float

    @property
    def parts(self) -> bool:
        """True if they part, beyond doubt."""
        return self.rate > _BEYOND * self.doubt

    @property
    def meets(self) -> bool:
        """True if they come together, beyond doubt."""
        return self.rate < -_BEYOND * self.doubt


def parting(
    structure: Structure, motion: Motion, begin: np.ndarray, mesh: float, meshes: int
) -> Parting:
    """How motions part from where a march has come to.

    Args:
        structure: the system.
        motion: what is given.
        begin: (coordinates,), see `period_map.Ended`.
        mesh: period of the mesh [s].
        meshes: of the period; so many are followed, and at least some.

    Raises:
        CoreStopped: a march fails.
    """
    way = PeriodMap(structure, motion, _LONGEST)
    places = _PLACES * _AHEAD
    swung = way.along(begin, _AHEAD * mesh, places).x
    weights = _weights(swung[:, :-1])
    x, apart = begin, swung[_PLACES // 2] - swung[0]
    apart[-1] = 0.0
    apart *= _APART / _size(apart, weights)
    logs = []
    for _ in range(_AHEAD + max(meshes, _FEWEST)):
        now, other = way.end(x, mesh), way.end(x + apart, mesh)
        apart = other.x - now.x
        apart -= now.rate * (apart[-1] / now.rate[-1])
        grown = _size(apart, weights) / _APART
        logs.append(math.log(grown))
        apart, x = apart / grown, now.x
    means = np.array([part.mean() for part in np.array_split(logs[_AHEAD:], _BLOCKS)])
    return Parting(float(means.mean()), float(means.std(ddof=1) / math.sqrt(_BLOCKS)))


def _weights(swung: np.ndarray) -> np.ndarray:
    """(2 modes,) one over how far coordinates (places, 2 modes) go; 0 of those that stand."""
    parts = (np.split(each, 2) for each in (np.ptp(swung, axis=0), np.abs(swung).max(axis=0)))
    every = (np.hypot(*each) for each in parts)
    swing, size = (np.tile(each, 2) for each in every)
    return np.where(swing > _STANDS * size, 1.0 / np.maximum(swing, np.finfo(float).tiny), 0.0)


def _size(apart: np.ndarray, weights: np.ndarray) -> float:
    """Distance of coordinates, over their swings."""
    return float(np.sqrt(np.mean((apart[:-1] * weights) ** 2)))
