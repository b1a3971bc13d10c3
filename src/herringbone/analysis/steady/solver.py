"""Steady states of one system at many operating points."""

from collections.abc import Callable, Iterator, Mapping
from copy import copy
from functools import cache, partial

import numpy as np

from herringbone.analysis.steady.bending import bending_parts
from herringbone.analysis.steady.found import Found, by_marching, none_found
from herringbone.analysis.steady.guess import (
    LONG,
    PLACES,
    SETTLING,
    Guess,
    Neighbour,
    begun,
    begun_shortly,
    motion_at,
    settling,
    several,
    standing,
    turns,
)
from herringbone.analysis.steady.harmonic_balance.accuracy import accuracy
from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
from herringbone.analysis.steady.marching.marched import March
from herringbone.analysis.steady.marching.repeated import Repeated
from herringbone.analysis.steady.resolution import first
from herringbone.analysis.steady.set_points import Point
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.steady.structure import Structure
from herringbone.analysis.twin.condensed.lean import WHOLE, Lean
from herringbone.core import ParameterError
from herringbone.core.one_thread import one_blas_thread
from herringbone.cosim.structure.system import System

TOLERANCE = 1e-3
AS_IT_IS = Point()
_TRIED, _REPEATS = 2, 0.1
"""Of a march: how many periods of repetition are tried; a change over the alternation that is none.
"""


_NO_ROTATION = (
    "no steady rotation: what drives and what loads balance at no speed; look for a load "
    "beyond what the drive gives"
)


_NO_LOAD = "torque = 0 N m: nothing holds the teeth together, which drift apart; ask for a load"


class SteadySolver:
    """Periodic steady states of a system, prepared once.

    Set points (speed and torque) change nothing that was prepared. Values that do not change the
    linear part, such as those of the contact, prepare the laws alone again; of any other the system
    is taken apart again.

    Args:
        system: with start values of steady rotation, see `running.prepared`; its parts are all
            components of this package.
        tolerance: error of the alternating part of each group of channels.
        lean: what the model leaves out.

    Raises:
        ParameterError: the tolerance is none.
        StructureError: the system cannot be taken apart, or its motion does not repeat.
    """

    def __init__(self, system: System, tolerance: float = TOLERANCE, *, lean: Lean = WHOLE) -> None:
        if not 0.0 < tolerance < 1.0:
            raise ParameterError(f"tolerance = {tolerance:g}: it must lie between 0 and 1")
        self._system, self.tolerance = system, tolerance
        self._structure = Structure(system, lean=lean)
        self._values: Mapping[str, float | str] = {}

    @property
    def structure(self) -> Structure:
        """The system, prepared with the values that were solved for last."""
        return self._structure

    def leaner(self, lean: Lean, tolerance: float | None = None) -> "SteadySolver":
        """The same of a leaner model; see `Structure.leaner`. Without a tolerance, as this."""
        found = copy(self)
        found.tolerance = tolerance or self.tolerance
        if lean:
            found._structure = self._structure.leaner(lean)
        return found

    def solve(
        self, point: Point = AS_IT_IS, near: SteadyState | Neighbour | None = None
    ) -> SteadyState:
        """The steady state at an operating point.

        Args:
            point: what differs from the system as it is.
            near: the state at a point nearby, to begin from; from equilibrium if not given.

        Returns:
            A state; ask it whether it is `converged`.

        Raises:
            ParameterError: the system declares no such set point, or the point has no motion that
                could repeat.
        """
        point.check()
        near = near.neighbour if isinstance(near, SteadyState) else near
        with one_blas_thread(), np.errstate(all="ignore"):
            structure = self._at(point)
            given = motion_at(structure, point)
            found, notes = self._found(structure, given, near, point)
        motion, orbit, errors, settled = found
        if point.torque == 0.0 and not (orbit.converged and errors.left_out):
            orbit = orbit._replace(converged=False)  # rest with open teeth may be at any gap
            notes = (*notes, _NO_LOAD)
        before = near._replace(before=None) if near else None
        return SteadyState(
            structure, point, motion, orbit, errors, self.tolerance, notes, settled, before
        )

    def _at(self, point: Point) -> Structure:
        """The structure with the values of a point."""
        values = self._structure.points.values(point)
        if values != self._values:
            self._structure = Structure(self._system.with_values(values), self._structure)
            self._values = values
        return self._structure

    def _found(
        self, structure: Structure, motion: Motion, near: Neighbour | None, point: Point
    ) -> tuple[Found, tuple[str, ...]]:
        """The motion from a neighbour or the equilibrium; else from a march; and remarks."""
        unstable, found = None, None
        at_rest = cache(partial(standing, structure, motion))  # a neighbour often needs none
        for times, guess in self._guesses(structure, motion, at_rest, near, point):
            tried = self._resolved(structure, several(motion, times), times, guess)
            if tried is None:
                break
            found = tried
            if found.good(self.tolerance):
                if not (bending_parts(structure, found.orbit) and found.grows(structure, times)):
                    return found, _told(times)
                unstable = unstable or found
            elif structure.meshes >= LONG and _searched(found):
                break  # that took long, and is no better from elsewhere
        still = at_rest()
        found = found or none_found(motion, still)
        if not turns(still):
            return found, (_NO_ROTATION,)
        march = settling(structure, motion, still, PLACES)
        if march is not None:
            for times in march.likely(_REPEATS)[:_TRIED]:
                values = march.harmonics(times)
                guess = Guess(values, np.arange(values.shape[1]), PLACES)
                tried = self._resolved(structure, several(motion, times), times, guess)
                if tried and tried.good(self.tolerance) and not tried.grows(structure, times):
                    return tried, _told(times)
        if structure.meshes > 1 and structure.problem.free is None:
            return self._marched(structure, motion, still, found)
        return unstable or found, (*_grows(unstable), _unsettled(structure, march))

    def _marched(
        self, structure: Structure, motion: Motion, still: Orbit, found: Found
    ) -> tuple[Found, tuple[str, ...]]:
        """The motion that a march repeats, or what was found before; and remarks."""
        repeating, march = by_marching(structure, motion, still, self.tolerance)
        if repeating is not None and march is not None:
            return repeating, _told(march.times)
        return found, (_not_repeating(march),)

    @staticmethod
    def _guesses(
        structure: Structure,
        motion: Motion,
        at_rest: Callable[[], Orbit],
        near: Neighbour | None,
        point: Point,
    ) -> Iterator[tuple[int, Guess]]:
        """Periods, and where an iteration begins: at a neighbour, then at equilibrium."""
        if near is not None and near.meshes % structure.meshes == 0:
            times, ahead = near.meshes // structure.meshes, near.towards(point)
            yield times, ahead
            if ahead is not near.guess:
                yield times, near.guess
        if shortly := begun_shortly(structure, motion, at_rest(), PLACES):
            yield 1, shortly
        yield 1, begun(structure, motion, at_rest(), PLACES)

    def _resolved(
        self, structure: Structure, motion: Motion, times: int, guess: Guess
    ) -> Found | None:
        """A motion over some periods with as many harmonics as the tolerance needs.

        None if these are more than the lines of a long period.
        """
        problem, resolution = structure.problem, first(guess.per_mesh, self.tolerance)
        start, known = guess.values, guess.orders
        while True:
            period = resolution.period(structure, times)
            if period is None:
                return None
            orbit = Balance(problem, period, motion).solve(start, known, self.tolerance)
            if not (orbit.converged and turns(orbit)):
                return none_found(motion, orbit)
            errors = accuracy(structure, period, motion, orbit)
            if errors.worst <= self.tolerance or resolution.finest(period):
                return Found(motion, orbit, errors)
            start, known = orbit.channels[: problem.values], orbit.response.orders
            resolution = resolution.finer(errors, self.tolerance)


def _searched(found: Found) -> bool:
    """True of places of a whole period, and of a motion that was looked at as finely as can be."""
    return found.orbit.converged or not found.orbit.resolved.bases


def _grows(unstable: Found | None) -> tuple[str, ...]:
    """What is said of a motion that is not stable."""
    return ("unstable: small deviations grow, a run would leave this motion",) if unstable else ()


def _unsettled(structure: Structure, march: March | None) -> str:
    """Why there is no march that could be followed to a motion."""
    if structure.meshes >= LONG:
        return (
            f"its period of {structure.meshes} meshes is too long for a march in which nothing "
            "holds the speed; join a drive and a load, or set run-outs and deviations to 0"
        )
    if march is None:
        return "a march from equilibrium fails, too"
    return (
        f"no stable periodic motion was found: {SETTLING:g} s from equilibrium a march still "
        f"changes by {100.0 * march.least:.2g} % from one period to later ones"
    )


def _not_repeating(march: Repeated | None) -> str:
    """Why there is no march that repeats, of a period of many meshes."""
    if march is None:
        return "a march from equilibrium fails, too"
    return (
        f"no periodic motion was found: after {march.way.time:.3g} s from equilibrium a march "
        f"still changes by {100.0 * march.change:.2g} % from one period to later ones; teeth that "
        "rattle may never repeat: ask for a larger torque, or run it"
    )


def _told(times: int) -> tuple[str, ...]:
    return (f"subharmonic: it repeats after {times} periods",) if times > 1 else ()
