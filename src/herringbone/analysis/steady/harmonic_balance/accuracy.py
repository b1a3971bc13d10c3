"""How far a periodic motion is from what finer harmonics would give.

The laws are evaluated at twice as many places in time, at the same motion. What they give there and
the motion lacks, higher harmonics as well as what folds into lower ones, is sent through the linear
part: its answer, over the alternating part of a group of channels, is the error that is stated.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.fourier import among, on, squares
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit, Period
from herringbone.analysis.steady.harmonic_balance.problem import in_parts
from herringbone.analysis.steady.harmonic_balance.response import Rows
from herringbone.analysis.steady.structure import Structure

_THINNER = 0.03
_MOST = 0.7
_NOTHING = 1e-12
"""Alternating part of a group, over the terms of which its means are the sum, that is none."""

_NO_CHANNELS = np.zeros(0)


class Accuracy(NamedTuple):
    """Errors over the alternating part, by group of channels.

    Attributes:
        left_out: of what places twice as dense would add.
        thinned: the part of it that harmonics give which the places tell apart, but which are not
            in use.
        aside: the part of it that lines farther aside give, of a period of lines alone.
        change: of the last correction of the iteration, whose square is about what is left.
        of_channels: (n,) as left_out, of each channel over its own alternating part, as they stand
            in the rows of `Structure.groups`; NaN of what stands still.
        lacking: how far the laws' values are off, over their sizes, where no group alternates.
    """

    left_out: Mapping[str, float]
    thinned: Mapping[str, float]
    aside: Mapping[str, float]
    change: Mapping[str, float]
    of_channels: np.ndarray = _NO_CHANNELS
    lacking: float = 0.0

    @property
    def worst(self) -> float:
        """The largest error."""
        return max(self.left_out.values(), default=self.lacking)

    @property
    def by_thinning(self) -> bool:
        """True if harmonics that are not in use are most of the largest error."""
        return self._mostly(self.thinned)

    @property
    def by_sides(self) -> bool:
        """True if lines farther aside are most of the largest error."""
        return self._mostly(self.aside)

    def _mostly(self, part: Mapping[str, float]) -> bool:
        largest = max(self.left_out, key=self.left_out.__getitem__, default="")
        return bool(largest) and part[largest] > _MOST * self.left_out[largest]


def accuracy(structure: Structure, period: Period, motion: Motion, orbit: Orbit) -> Accuracy:
    """Errors of a motion that was found with a period's resolution."""
    groups, rows = structure.groups
    twice = period.doubled._replace(thin=_THINNER * period.thin)
    response, missing, outside = Balance(structure.problem, twice, motion).missing(orbit)
    values = orbit.response.outputs(rows, orbit.q, orbit.channels)
    lacking = response.outputs(rows, response.coordinates(missing), missing)
    moved = orbit.response.outputs(rows, orbit.moved, orbit.step)
    apart = ~among(response.orders, orbit.response.orders)
    apart &= period.told_apart(response.orders)
    aside = response.orders < period.per_mesh // 2 * period.meshes
    aside &= ~period.told_apart(response.orders)
    powers = squares(lacking)
    every, whole, last = powers[:, 1:].sum(axis=1), _alternating(values), _alternating(moved)
    missed, lines = powers[:, apart].sum(axis=1), powers[:, aside].sum(axis=1)
    nothing = _NOTHING * _terms(rows, orbit)
    left_out, thinned, besides, change = {}, {}, {}, {}
    for group, own in groups.items():
        alternating = math.sqrt(whole[own].sum())
        if alternating > nothing[own].max(initial=0.0):
            left_out[group] = math.sqrt(every[own].sum()) / alternating + outside
            thinned[group] = math.sqrt(missed[own].sum()) / alternating
            besides[group] = math.sqrt(lines[own].sum()) / alternating + outside
            change[group] = math.sqrt(last[own].sum()) / alternating
    moving = whole > nothing**2
    of_channels = np.sqrt(np.where(moving, every, np.nan) / np.where(moving, whole, 1.0)) + outside
    still = 0.0
    if not left_out:
        balance = Balance(structure.problem, period, motion)
        still = balance.lacking(orbit.channels, orbit.response.orders)[0].residual
    return Accuracy(left_out, thinned, besides, change, of_channels, still)


def with_change(structure: Structure, errors: Accuracy, before: Orbit, after: Orbit) -> Accuracy:
    """Errors of a motion, and what it has changed by from an earlier one, together."""
    groups, rows = structure.groups
    known, orders = before.response, after.response.orders
    earlier = on(orders, known.outputs(rows, before.q, before.channels), known.orders)
    values = after.response.outputs(rows, after.q, after.channels)
    moved, whole = _alternating(values - earlier), _alternating(values)
    left_out = {
        group: error + math.sqrt(moved[groups[group]].sum() / whole[groups[group]].sum())
        for group, error in errors.left_out.items()
    }
    of_channels = errors.of_channels + np.sqrt(moved / np.where(whole > 0.0, whole, np.nan))
    return errors._replace(left_out=left_out, of_channels=of_channels)


def _alternating(coefficients: np.ndarray) -> np.ndarray:
    """(n,) sums of the squares of coefficients (n, harmonics) beside the means."""
    return squares(coefficients[:, 1:]).sum(axis=1)


def _terms(rows: Rows, orbit: Orbit) -> np.ndarray:
    """(n,) sizes of what adds up to the means of rows.

    A seat that nothing shakes has a mean velocity of zero, and rounding of its terms shakes it.
    """
    found = np.abs(in_parts(rows.modal)) @ np.abs(orbit.q[:, 0])
    return found + np.abs(rows.of_channels) @ np.abs(orbit.channels[:, 0])
