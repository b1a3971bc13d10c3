"""How finely a period is looked at, and what is made finer if that was not enough."""

from typing import NamedTuple

from herringbone.analysis.steady.harmonic_balance.accuracy import Accuracy
from herringbone.analysis.steady.harmonic_balance.orbit import Period
from herringbone.analysis.steady.searching.guess import LONG
from herringbone.analysis.steady.structure import Structure

_MOST_PLACES, _MOST_IN_ALL, _MOST_MARCHED = 2048, 150_000, 300_000
"""Points in time of a mesh period, and of a long one that is solved for or marched, from which on
they are not doubled."""
_THIN = 0.005
"""Alternating part of the contact that harmonics may have that are not in use, over the tolerance:
at first, of many meshes."""
_THINNER = 0.3
_FAR = 0.3
"""Error from which on lines alone miss what fills the spectrum, as deviations of teeth do."""
_EVERY = 10_000
"""So far aside that no line is left out."""
SIDES = 3
"""How far aside lines are looked for in long periods, at first."""


class Resolution(NamedTuple):
    """How finely a period is looked at.

    Attributes:
        per_mesh: points in time of a mesh period.
        thin: of many meshes, alternating part that harmonics may have that are not in use.
        sides: how far aside lines are looked for in long periods.
    """

    per_mesh: int
    thin: float
    sides: int

    def period(self, structure: Structure, times: int) -> Period | None:
        """Of so many periods of a structure; None of a long one that lines alone do not tell.

        A march tells that, unless nothing holds the speed, which would drift meanwhile: then all
        places are taken.
        """
        found = self.all_places(structure, times)
        if times > 1 or found.meshes < LONG:
            return found
        if structure.problem.free is not None:
            return found.thinned_to_lines(structure.bases, self.sides) or found
        if self.sides >= _EVERY:
            return None
        return found.thinned_to_lines(structure.bases, self.sides)

    def all_places(self, structure: Structure, times: int) -> Period:
        """Of so many periods of a structure, at all places."""
        meshes = times * structure.meshes
        return Period(self.per_mesh // 4, meshes * self.per_mesh, meshes, self.thin)

    def finest(self, period: Period, *, marched: bool = False) -> bool:
        """True if a period that was looked at so is not to be looked at more finely.

        Args:
            period: that was looked at.
            marched: its motion is known in time, and nothing solved for.
        """
        most = _MOST_MARCHED if marched else _MOST_IN_ALL
        long = period.meshes >= LONG and period.places > most
        return long or self.per_mesh >= _MOST_PLACES

    def finer(self, errors: Accuracy, tolerance: float) -> "Resolution":
        """What makes the largest part of the errors smaller."""
        if errors.by_thinning:
            return self._replace(thin=self.thin * _THINNER * tolerance / errors.worst)
        if errors.worst > _FAR and self.sides < _EVERY:
            return self._replace(sides=_EVERY)
        if errors.by_sides:
            return self._replace(sides=2 * self.sides)
        return self._replace(per_mesh=2 * self.per_mesh)


def first(per_mesh: int, tolerance: float) -> Resolution:
    """As coarse as may do for a tolerance."""
    return Resolution(per_mesh, _THIN * tolerance, SIDES)
