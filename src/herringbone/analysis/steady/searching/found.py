"""What a search for a periodic motion has found, and the search by marching."""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.accuracy import Accuracy, accuracy, with_change
from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.floquet import multipliers
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
from herringbone.analysis.steady.marching.repeated import (
    INSIDE,
    Repeated,
    repeated,
    with_halved_steps,
)
from herringbone.analysis.steady.marching.shooting import Shooting, Shot
from herringbone.analysis.steady.searching.guess import PLACES, several
from herringbone.analysis.steady.searching.irregular import Irregular
from herringbone.analysis.steady.searching.resolution import first
from herringbone.analysis.steady.structure import Structure

_STEPS, _NEUTRAL = 256, 1e-3
"""Steps of a mesh period in which deviations are followed; growth that is rounding of these."""
_FALLS, _HALVED = 0.95, 6
"""By what an error falls at least with four times the harmonics; how often steps are halved."""
_SHARED, _OF_HARMONICS = 2, 0.5
"""Halvings from which on harmonics may leave out that part of the tolerance: steps have the rest.
"""
_SETTLED = 0.1
"""Change from one period of a march to the next that counts as none, over the tolerance."""


class Settled(NamedTuple):
    """How a march has settled.

    Attributes:
        time: that was marched [s].
        change: of the laws' values from one period to the next, over their alternating part.
    """

    time: float
    change: float


class Found(NamedTuple):
    """A motion, what is given of it, and its errors; what tells of the march or shot it is of.

    Without a motion, what tells that there is none.
    """

    motion: Motion
    orbit: Orbit
    errors: Accuracy
    by: Settled | Shot | Irregular | None = None

    @property
    def shot(self) -> Shot | None:
        """The shot that it is of."""
        return self.by if isinstance(self.by, Shot) else None

    def good(self, tolerance: float) -> bool:
        """True if it is a motion, with all harmonics that a tolerance needs."""
        return self.orbit.converged and self.errors.worst <= tolerance

    def grows(self, structure: Structure, times: int) -> bool:
        """True if small deviations grow; of many meshes that is not asked for."""
        if self.shot:
            return self.shot.multipliers.largest > 1.0 + _NEUTRAL
        if structure.meshes > 1:
            return False
        steps = max(_STEPS, self.orbit.places // (2 * times)) * times
        largest = multipliers(structure.problem, self.motion, self.orbit, steps).largest
        return largest > 1.0 + _NEUTRAL


def none_found(motion: Motion, orbit: Orbit) -> Found:
    """What there is without a motion."""
    return Found(motion, orbit._replace(converged=False), Accuracy({}, {}, {}, {}))


def by_marching(
    structure: Structure, motion: Motion, still: Orbit, tolerance: float
) -> tuple[Found | None, Repeated | None]:
    """The motion that a march from equilibrium repeats, and that march; None if it does not.

    Args:
        structure: the system.
        motion: what is given of one period.
        still: equilibrium.
        tolerance: error of the alternating part of each group of channels.
    """
    resolution = first(PLACES, tolerance)
    march = repeated(structure, motion, still, resolution.per_mesh, _SETTLED * tolerance)
    if march is None or march.change > _SETTLED * tolerance:
        return None, march
    now, once, motion = march, motion, several(motion, march.times)

    def values(per_mesh: int) -> np.ndarray:
        nonlocal now
        if per_mesh > PLACES:
            now = now.finer(per_mesh // PLACES)
        return now.march.harmonics(now.times)

    def stepped(halved: int) -> Found | None:
        nonlocal now
        if halved:
            now = with_halved_steps(structure, once, now, _SETTLED * tolerance)
            if now.change > _SETTLED * tolerance:
                return None
        close = _left_out(tolerance, halved)
        found = _in_harmonics(structure, motion, now.times, close, values)
        return found._replace(by=Settled(now.way.time, now.change))

    return _with_steps(structure, stepped, tolerance), now


def by_shooting(
    structure: Structure,
    motion: Motion,
    times: int,
    begin: tuple[np.ndarray, float],
    tolerance: float,
) -> Found | None:
    """The motion that shooting comes to; None if it comes to none.

    Args:
        structure: the system; something holds its speed.
        motion: what is given of one period.
        times: periods after which it is to repeat.
        begin: coordinates, see `period_map.Ended`, and a period [s], to begin from.
        tolerance: error of the alternating part of each group of channels.
    """
    motion, meshes = several(motion, times), times * structure.meshes
    x, period, rounds = begin[0], times * begin[1], 0

    def stepped(halved: int) -> Found | None:
        nonlocal x, period, rounds
        shooting = Shooting(structure, motion, meshes, tolerance, 0.5**halved)
        shot = shooting.shot(x, period, _SETTLED * tolerance)
        if shot is None:
            return None
        x, period, rounds = shot.begin, shot.period, rounds + shot.rounds
        shot = shot._replace(rounds=rounds)
        values = partial(_values_of, shooting, shot, meshes)
        close = _left_out(tolerance, halved)
        return _in_harmonics(structure, motion, times, close, values)._replace(by=shot)

    return _with_steps(structure, stepped, tolerance)


def _with_steps(
    structure: Structure, found_with: Callable[[int], Found | None], tolerance: float
) -> Found | None:
    """A motion whose steps are halved until that changes it by no more than the tolerance leaves.

    Laws that bend within a step make errors that harmonics do not tell: a march repeats with them.

    Args:
        structure: the system.
        found_with: the motion with steps halved so many times, from the one before.
        tolerance: error of the alternating part of each group of channels.
    """
    before = found_with(0)
    if before is None:
        return None
    for halved in range(1, _HALVED + 1):
        found = found_with(halved)
        if found is None:
            return None
        errors = with_change(structure, found.errors, before.orbit, found.orbit)
        before = found._replace(errors=errors)
        if before.good(tolerance):
            break
    return before


def _left_out(tolerance: float, halved: int) -> float:
    """What harmonics may leave out of a motion whose steps were halved so many times."""
    return tolerance if halved < _SHARED else _OF_HARMONICS * tolerance


def _values_of(shooting: Shooting, shot: Shot, meshes: int, per_mesh: int) -> np.ndarray:
    """Coefficients of the laws' values over a period, by more places than were asked for."""
    return shooting.march(shot, INSIDE * per_mesh * meshes).harmonics(1)


def _in_harmonics(
    structure: Structure,
    motion: Motion,
    times: int,
    tolerance: float,
    values_of: Callable[[int], np.ndarray],
) -> Found:
    """A motion that is known in time, with as many harmonics as the tolerance needs.

    Args:
        structure: the system.
        motion: what is given of the whole of it.
        times: periods after which it repeats.
        tolerance: error of the alternating part of each group of channels.
        values_of: coefficients of the laws' values, at so many places of a mesh period or more.
    """
    resolution, before = first(PLACES, tolerance), (np.inf, np.inf)
    while True:
        period = resolution.all_places(structure, times)
        values = values_of(resolution.per_mesh)[:, : period.places // 2]
        known = np.arange(values.shape[1])
        orbit = Balance(structure.problem, period, motion).along(values, known)
        errors = accuracy(structure, period, motion, orbit)
        stalls = errors.worst > _FALLS * before[0]  # then it is the march's own error
        if errors.worst <= tolerance or resolution.finest(period, marched=True) or stalls:
            return Found(motion, orbit, errors)
        resolution = resolution.finer(errors, tolerance)
        before = before[1], errors.worst
