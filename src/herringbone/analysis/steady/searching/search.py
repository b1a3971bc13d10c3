"""The search for a periodic motion of a system at one operating point.

Harmonic balance from a neighbour or the equilibrium comes first, as it takes milliseconds; where it
comes to nothing, or to what a run would leave, a march, and harmonic balance or shooting from where
that has come to; of a period of many meshes a march that goes on until it repeats.
"""

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from herringbone.analysis.steady.bending import bending_parts
from herringbone.analysis.steady.harmonic_balance.accuracy import accuracy
from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
from herringbone.analysis.steady.marching.march import March
from herringbone.analysis.steady.marching.marched import Following, start_of
from herringbone.analysis.steady.searching.found import Found, by_marching, by_shooting, none_found
from herringbone.analysis.steady.searching.guess import (
    LONG,
    PLACES,
    SETTLING,
    Guess,
    beginnings,
    begun,
    begun_shortly,
    settling,
    several,
    standing,
    turns,
)
from herringbone.analysis.steady.searching.irregular import irregular
from herringbone.analysis.steady.searching.remarks import (
    GROWS,
    NO_SHOT,
    never_repeats,
    not_exact,
    not_marched,
    not_repeating,
    told,
    unsettled,
)
from herringbone.analysis.steady.searching.resolution import first
from herringbone.analysis.steady.structure import Structure
from herringbone.core import HerringboneError

_TRIED, _REPEATS = 2, 0.1
"""Of a march: how many periods of repetition are tried; a change over the alternation that is none.
"""
_APPROACH, _KEPT = 16, 8
"""Periods that are marched before the first shot, and of these the ones that are looked at."""

Result = tuple[Found, tuple[str, ...]]
"""What was found, and remarks."""


class Search:
    """A search for one motion.

    Args:
        structure: the system.
        motion: what is given of a period.
        tolerance: error of the alternating part of each group of channels.
        near: guesses that lead on from a motion nearby, the best one first, and the periods after
            which that repeats.
    """

    def __init__(
        self,
        structure: Structure,
        motion: Motion,
        tolerance: float,
        near: Sequence[tuple[int, Guess]],
    ) -> None:
        self._structure, self._motion, self._tolerance = structure, motion, tolerance
        self._near = near

    @cached_property
    def _still(self) -> Orbit:
        """Equilibrium; a neighbour often needs none."""
        return standing(self._structure, self._motion)

    @cached_property
    def _not_marched(self) -> str:
        """Why there is no march from there; empty if there is."""
        return not_marched(self._structure, self._still)

    def found(self) -> Result:
        """The motion by the cheapest way that comes to one, or as far as it was found."""
        structure = self._structure
        unstable, found = None, None
        for times, guess in self._guesses():
            tried = self._resolved(times, guess)
            if tried is None:
                break
            found = tried
            if found.good(self._tolerance):
                if not (bending_parts(structure, found.orbit) and found.grows(structure, times)):
                    return found, told(times)
                unstable = unstable or found
            elif structure.meshes >= LONG and _searched(found):
                break  # that took long, and is no better from elsewhere
        found = found or none_found(self._motion, self._still)
        if self._not_marched:
            return found, (self._not_marched,)
        march = settling(structure, self._motion, self._still, PLACES)
        if march is not None:
            for times, tried in self._after(march):
                if not tried.grows(structure, times):
                    return tried, told(times)
                unstable = unstable or tried
        if structure.meshes > 1 and structure.problem.free is None:
            return self._marched(found)
        said = (unsettled(structure, march),)
        return (unstable, (GROWS, *said)) if unstable else (found, said)

    def _after(self, march: March) -> Iterator[tuple[int, Found]]:
        """Motions, and periods of them, from where a march has come to; they may be unstable."""
        structure, likely = self._structure, march.likely(_REPEATS)[:_TRIED]
        for times in likely:
            values = march.harmonics(times)
            guess = Guess(values, np.arange(values.shape[1]), PLACES)
            tried = self._resolved(times, guess)
            if tried and tried.good(self._tolerance):
                yield times, tried
        if structure.meshes == 1 and structure.problem.free is None:
            for times in likely:
                if shot := self._shot(times, march.end, self._still.period):
                    yield shot

    def shot(self) -> Result:
        """The motion by shooting: from a neighbour, whose branch it follows, else from marches."""
        unstable: Result | None = None
        for several_times, begin, period in self._starts():
            shot = self._shot(several_times, begin, period)
            if shot is None:
                continue
            times, found = shot
            grows = found.grows(self._structure, times)
            result = found, (*((GROWS,) if grows else ()), *told(times))
            if self._near or not grows:
                return result
            unstable = unstable or result
        said = self._not_marched or NO_SHOT
        return unstable or (none_found(self._motion, self._still), (said,))

    def _starts(self) -> Iterator[tuple[int, np.ndarray, float]]:
        """Periods after which it may repeat, coordinates, and a period [s], to shoot from."""
        structure = self._structure
        for times, guess in self._near:
            period = first(guess.per_mesh, self._tolerance).all_places(structure, times)
            balance = Balance(structure.problem, period, several(self._motion, times))
            orbit = balance.along(guess.values, guess.orders)
            yield times, start_of(orbit), orbit.period / times
        if self._not_marched:
            return
        places = structure.meshes * PLACES
        settled = SETTLING / self._still.period
        for begin, ramp in beginnings(structure, self._motion, self._still):
            way = Following(structure, self._motion, begin, places, ramp)
            turned = ramp / abs(structure.turns_of_pinion)
            for periods in (turned + _APPROACH, max(settled, _APPROACH)):
                try:
                    march = way.on(int(np.ceil(periods)) * places, _KEPT * places)
                except HerringboneError:
                    break
                for times in march.likely(_REPEATS)[:_TRIED]:
                    yield times, march.end, self._still.period

    def _shot(self, times: int, begin: np.ndarray, period: float) -> tuple[int, Found] | None:
        """By shooting, and the fewest periods after which it repeats; None if it is no motion."""
        found = self._shot_at(times, begin, period)
        if found is None or found.shot is None:
            return None
        for fewer in (n for n in range(1, times) if times % n == 0):
            same = self._shot_at(fewer, found.shot.begin, found.shot.period / times)
            if same and same.shot and same.shot.rounds == 0:
                return fewer, same
        return times, found

    def _shot_at(self, times: int, begin: np.ndarray, period: float) -> Found | None:
        start = begin, period
        found = by_shooting(self._structure, self._motion, times, start, self._tolerance)
        return found if found and found.good(self._tolerance) else None

    def _marched(self, found: Found) -> Result:
        """The motion that a march repeats, or what was found before."""
        repeating, march = by_marching(self._structure, self._motion, self._still, self._tolerance)
        if repeating is not None and march is not None:
            said = told(march.times)
            if not repeating.good(self._tolerance):
                said = (*said, not_exact(repeating, self._tolerance))
            return repeating, said
        never = irregular(self._structure, self._motion, march) if march else None
        if march is None or never is None:
            return found, (not_repeating(march),)
        return none_found(self._motion, self._still)._replace(by=never), (never_repeats(never),)

    def _guesses(self) -> Iterator[tuple[int, Guess]]:
        """Periods, and where harmonic balance begins: at a neighbour, then at equilibrium."""
        structure, motion = self._structure, self._motion
        yield from self._near
        if shortly := begun_shortly(structure, motion, self._still, PLACES):
            yield 1, shortly
        if structure.meshes == 1 or not self._not_marched:
            yield 1, begun(structure, motion, self._still, PLACES)

    def _resolved(self, times: int, guess: Guess) -> Found | None:
        """By harmonic balance: over some periods, with the harmonics that the tolerance needs.

        None if these are more than the lines of a long period.
        """
        structure, motion = self._structure, several(self._motion, times)
        resolution = first(guess.per_mesh, self._tolerance)
        start, known = guess.values, guess.orders
        while True:
            period = resolution.period(structure, times)
            if period is None:
                return None
            balance = Balance(structure.problem, period, motion)
            orbit = balance.solve(start, known, self._tolerance)
            if not (orbit.converged and turns(orbit, period.meshes)):
                return none_found(motion, orbit)
            errors = accuracy(structure, period, motion, orbit)
            if errors.worst <= self._tolerance or resolution.finest(period):
                return Found(motion, orbit, errors)
            start, known = orbit.channels[: structure.problem.values], orbit.response.orders
            resolution = resolution.finer(errors, self._tolerance)


def _searched(found: Found) -> bool:
    """True of places of a whole period, and of a motion that was looked at as finely as can be."""
    return found.orbit.converged or not found.orbit.resolved.bases
