"""Steady states of one system at many operating points."""

from collections.abc import Iterator, Mapping
from copy import copy
from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.bending import bending_parts
from herringbone.analysis.steady.guess import (
    LONG,
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
from herringbone.analysis.steady.harmonic_balance.accuracy import Accuracy, accuracy
from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.floquet import multipliers
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
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
_PLACES = 64
"""Points in time of a mesh period, at first."""
_TRIED, _REPEATS = 2, 0.1
"""Of a march: how many periods of repetition are tried; a change over the alternation that is none.
"""
_STEPS, _NEUTRAL = 256, 1e-3
"""Steps of a mesh period in which deviations are followed; growth that is rounding of these."""


_NO_ROTATION = (
    "no steady rotation: what drives and what loads balance at no speed; look for a load "
    "beyond what the drive gives"
)


class Found(NamedTuple):
    """A motion, what is given of it, and its errors."""

    motion: Motion
    orbit: Orbit
    errors: Accuracy

    def good(self, tolerance: float) -> bool:
        """True if it is a motion, with all harmonics that a tolerance needs."""
        return self.orbit.converged and self.errors.worst <= tolerance

    def grows(self, structure: Structure, times: int) -> bool:
        """True if small deviations grow; of many meshes that is not asked for."""
        if structure.meshes > 1:
            return False
        steps = max(_STEPS, self.orbit.places // (2 * times)) * times
        largest = multipliers(structure.problem, self.motion, self.orbit, steps).largest
        return largest > 1.0 + _NEUTRAL


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
            (motion, orbit, errors), notes = self._found(structure, given, near)
        return SteadyState(structure, point, motion, orbit, errors, self.tolerance, notes)

    def _at(self, point: Point) -> Structure:
        """The structure with the values of a point."""
        values = self._structure.points.values(point)
        if values != self._values:
            self._structure = Structure(self._system.with_values(values), self._structure)
            self._values = values
        return self._structure

    def _found(
        self, structure: Structure, motion: Motion, near: Neighbour | None
    ) -> tuple[Found, tuple[str, ...]]:
        """The motion from a neighbour or the equilibrium; else from a march; and remarks."""
        unstable = None
        for times, guess in self._guesses(structure, motion, near):
            found = self._resolved(structure, several(motion, times), times, guess)
            if found.good(self.tolerance):
                if not (bending_parts(structure, found.orbit) and found.grows(structure, times)):
                    return found, _told(times)
                unstable = unstable or found
            elif structure.meshes >= LONG and not found.orbit.resolved.bases:
                break  # places of the whole period take long, and know no better from elsewhere
        still = standing(structure, motion)
        if not turns(still):
            return found, (_NO_ROTATION,)
        march = settling(structure, motion, still, _PLACES)
        if march is None:
            return unstable or found, (*_grows(unstable), _not_marched(structure, found))
        for times in march.likely(_REPEATS)[:_TRIED]:
            values = march.harmonics(times)
            guess = Guess(values, np.arange(values.shape[1]), _PLACES)
            tried = self._resolved(structure, several(motion, times), times, guess)
            if tried.good(self.tolerance) and not tried.grows(structure, times):
                return tried, _told(times)
        return unstable or found, (
            *_grows(unstable),
            f"no stable periodic motion was found: {SETTLING:g} s from equilibrium a march still "
            f"changes by {100.0 * march.least:.2g} % from one period to later ones",
        )

    @staticmethod
    def _guesses(
        structure: Structure, motion: Motion, near: Neighbour | None
    ) -> Iterator[tuple[int, Guess]]:
        """Periods, and where an iteration begins: at a neighbour, then at equilibrium."""
        if near is not None and near.meshes % structure.meshes == 0:
            yield near.meshes // structure.meshes, near.guess
        still = standing(structure, motion)
        if shortly := begun_shortly(structure, motion, still, _PLACES):
            yield 1, shortly
        yield 1, begun(structure, motion, still, _PLACES)

    def _resolved(self, structure: Structure, motion: Motion, times: int, guess: Guess) -> Found:
        """A motion over some periods with as many harmonics as the tolerance needs."""
        problem, resolution = structure.problem, first(guess.per_mesh, self.tolerance)
        start, known = guess.values, guess.orders
        while True:
            period = resolution.period(structure, times)
            orbit = Balance(problem, period, motion).solve(start, known, self.tolerance)
            if not orbit.converged:
                return Found(motion, orbit, Accuracy({}, {}, {}, {}))
            errors = accuracy(structure, period, motion, orbit)
            if errors.worst <= self.tolerance or resolution.finest(period):
                return Found(motion, orbit, errors)
            start, known = orbit.channels[: problem.values], orbit.response.orders
            resolution = resolution.finer(errors, self.tolerance)


def _grows(unstable: Found | None) -> tuple[str, ...]:
    """What is said of a motion that is not stable."""
    return ("unstable: small deviations grow, a run would leave this motion",) if unstable else ()


def _not_marched(structure: Structure, found: Found) -> str:
    """Why there is no march that could be followed to a motion."""
    if structure.meshes < LONG:
        return "a march from equilibrium fails, too"
    off = found.errors.worst if found.orbit.converged else found.orbit.residual
    missed = "harmonics miss" if found.orbit.converged else "Newton's method stops at"
    return (
        f"its period of {structure.meshes} meshes is too long for a march that settles, and "
        f"{missed} {100.0 * off:.2g} %; set run-outs and deviations to 0, ask for a larger "
        "tolerance or torque, or run it"
    )


def _told(times: int) -> tuple[str, ...]:
    return (f"subharmonic: it repeats after {times} periods",) if times > 1 else ()
