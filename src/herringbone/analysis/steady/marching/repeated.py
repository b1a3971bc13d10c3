"""A periodic motion by marching: the condensed core goes on until it repeats.

Where deviations of single teeth fill the spectrum of a period of many meshes, Newton has ten
thousands of unknowns, and tangents that differ from mesh to mesh. The core has forgotten within
such a period where it began, as everything in it is damped: one period after the other is shooting
by successive substitution (K. Lust et al., SIAM J. Sci. Comput. 19, 1998, 1188-1209, without a
subspace for Newton), whose error falls by what a deviation is multiplied by in a period. Where
deviations grow, as of teeth that rattle, it never repeats; see `parting`.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
from herringbone.analysis.steady.marching.march import March
from herringbone.analysis.steady.marching.marched import Following
from herringbone.analysis.steady.marching.parting import Parting, parting
from herringbone.analysis.steady.searching.guess import SETTLING, beginnings
from herringbone.analysis.steady.structure import Structure
from herringbone.core import HerringboneError

_MOST, _MOST_TIMES = 8, 3
"""Periods that are marched at most, and after which it may repeat."""
_FARTHER = 24
"""Further ones, where motions beside it do not part."""
INSIDE = 4
"""Values kept for each place: laws that bend have harmonics beyond what places tell apart."""


class Repeated(NamedTuple):
    """What a march has come to.

    Attributes:
        way: which can go on.
        march: its last periods.
        times: periods after which it repeats.
        change: from the last of these to the one before, over the alternating part.
        parting: how motions beside it part, where it has not repeated for long.
    """

    way: Following
    march: March
    times: int
    change: float
    parting: Parting | None = None

    def finer(self, inside: int) -> "Repeated":
        """The same, gone on for as long as it repeats after, with more values for each place."""
        count = self.times * self.way.places
        return self._replace(march=self.way.on(count, count, inside * INSIDE))


def repeated(
    structure: Structure, motion: Motion, still: Orbit, per_mesh: int, close: float
) -> Repeated | None:
    """March from equilibrium until the motion repeats, or for some periods.

    Args:
        structure: the system.
        motion: what is given.
        still: equilibrium.
        per_mesh: places of a mesh period.
        close: change that counts as none, over the alternating part of the laws' values.

    Returns:
        What it has come to; its change tells whether it repeats. None if the march fails.
    """
    for begin, ramp in beginnings(structure, motion, still):
        way = Following(structure, motion, begin, structure.meshes * per_mesh, ramp)
        try:
            way.settle(SETTLING)
            found = _until_repeated(way, close, _MOST)
            if found.change <= close:
                return found
            apart = _parting(structure, motion, found)
            if not apart.parts:
                found = _until_repeated(way, close, _FARTHER)
        except HerringboneError:
            continue
        return found._replace(parting=apart)
    return None


def with_halved_steps(
    structure: Structure, motion: Motion, found: Repeated, close: float
) -> Repeated:
    """A march that repeats, with steps of half the length, until it repeats again, or for a while.

    Shorter steps have another motion, which it has to come to; in which teeth may rattle. A motion
    that was stable by longer steps alone is left but slowly: then it begins anew.

    Args:
        structure: the system.
        motion: what is given of one period.
        found: the march; it goes on.
        close: see `repeated`.

    Returns:
        What it has come to; its change tells whether it repeats.

    Raises:
        CoreStopped: the march fails.
    """
    found.way.halve()
    now = found.finer(1)
    for _ in range(_MOST):
        before, now = now.march, now.finer(1)
        both = now.march._replace(values=np.hstack([before.values, now.march.values]))
        now = now._replace(change=both.change(now.times))
        if now.change <= close:
            return now
    apart = _parting(structure, motion, now)
    if apart.parts or apart.meets:
        return now._replace(march=both, parting=apart)
    way = found.way.anew()
    way.settle(SETTLING)
    now = _until_repeated(way, close, _MOST)
    return now if now.change <= close else now._replace(parting=_parting(structure, motion, now))


def _parting(structure: Structure, motion: Motion, found: Repeated) -> Parting:
    """See `parting`, from where a march has come to."""
    mesh = found.way.period / structure.meshes
    return parting(structure, motion, found.march.end, mesh, structure.meshes)


def _until_repeated(way: Following, close: float, most: int) -> Repeated:
    periods: list[March] = []
    changes = {1: np.inf}
    for _ in range(most):
        periods = [*periods[-_MOST_TIMES:], way.on(way.places, way.places, INSIDE)]
        values = np.hstack([p.values for p in periods])
        whole = periods[0]._replace(values=values, end=periods[-1].end)
        changes = {times: whole.change(times) for times in range(1, len(periods))} or changes
        if min(changes.values()) <= close:
            break
    times = next((n for n, change in changes.items() if change <= close), 1)
    return Repeated(way, whole, times, changes[times])
