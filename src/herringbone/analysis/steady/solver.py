"""Steady states of one system at many operating points."""

from collections.abc import Iterator, Mapping
from copy import copy

import numpy as np

from herringbone.analysis.steady.branches import branch_of
from herringbone.analysis.steady.flanks import on_other_flank, prepared_flanks
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.searching.guess import Guess, Neighbour, motion_at
from herringbone.analysis.steady.searching.remarks import (
    NO_LOAD,
    check_shooting,
    other_flank,
)
from herringbone.analysis.steady.searching.search import Search
from herringbone.analysis.steady.state import SHOOTING, SteadyState
from herringbone.analysis.steady.structure import Structure
from herringbone.core import ParameterError
from herringbone.core.lean import WHOLE, Lean
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.structure.system import System

TOLERANCE = 1e-3
AUTO = "auto"
SOLVERS = (AUTO, SHOOTING)
"""What may be asked to solve: the cheapest way that finds a motion, or shooting alone."""
AS_IT_IS = Point()


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
        solver: one of `SOLVERS`.

    Raises:
        ParameterError: the system or the tolerance is none, or the solver is unknown.
        StructureError: the system cannot be taken apart, or its motion does not repeat.
    """

    def __init__(
        self,
        system: System,
        tolerance: float = TOLERANCE,
        *,
        lean: Lean = WHOLE,
        solver: str = AUTO,
    ) -> None:
        if not isinstance(system, System):
            raise ParameterError(
                f"system = {system!r:.60}: it takes a System with its start values, such as "
                "hb.steady(NAME).structure.system"
            )
        if not 0.0 < tolerance < 1.0:
            raise ParameterError(f"tolerance = {tolerance:g}: it must lie between 0 and 1")
        if solver not in SOLVERS:
            raise ParameterError(f"solver = {solver}: there are {', '.join(SOLVERS)}")
        self._system, self.tolerance, self._solver = system, tolerance, solver
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
            ParameterError: the system declares no such set point, the point has no motion that
                could repeat, or shooting was asked for where it cannot be done.
        """
        point.check()
        near = near.neighbour if isinstance(near, SteadyState) else near
        with one_blas_thread(), np.errstate(all="ignore"):
            structure = self._at(point)
            given = motion_at(structure, point)
            search = Search(structure, given, self.tolerance, _guesses(structure, near, point))
            if self._solver == SHOOTING:
                check_shooting(structure, point)
                found, notes = search.shot()
            else:
                found, notes = search.found()
        motion, orbit, errors, by = found
        if point.torque == 0.0 and not (orbit.converged and errors.left_out):
            orbit = orbit._replace(converged=False)  # rest with open teeth may be at any gap
            notes = (*notes, NO_LOAD)
        wrong = on_other_flank(structure, orbit) if orbit.converged else _reversed(structure, point)
        if wrong:
            orbit, notes = orbit._replace(converged=False), (other_flank(structure, wrong),)
        before = near._replace(before=None) if near else None
        return SteadyState(
            structure, point, motion, orbit, errors, self.tolerance, notes, by, before
        )

    def branch(self, state: SteadyState, speed: float) -> Iterator[SteadyState]:
        """Steady states along the branch of one, over the speed, around folds.

        Args:
            state: where it begins, at a speed that was asked for; all have its harmonics.
            speed: where it ends [rad/s].

        Yields:
            States behind it; the last one is at or beyond that speed, or, of a branch that comes
            back, beyond that of the first. Where it turns back, the next one has the note `FOLD`.

        Raises:
            ParameterError: the state was not found, the speed is not one that it can go to, or a
                period has too many unknowns.
            BranchLostError: no next state is found.
        """
        return branch_of(state, speed, self.tolerance)

    def _at(self, point: Point) -> Structure:
        """The structure with the values of a point."""
        values = self._structure.points.values(point)
        if values != self._values:
            self._structure = Structure(self._system.with_values(values), self._structure)
            self._values = values
        return self._structure


def _reversed(structure: Structure, point: Point) -> tuple[str, ...]:
    """Gear pairs that were prepared for another flank than a point's torque presses."""
    flanks = prepared_flanks(structure)
    return tuple(gear for gear in flanks if (point.torque or 0.0) * flanks[gear] < 0.0)


def _guesses(structure: Structure, near: Neighbour | None, point: Point) -> list[tuple[int, Guess]]:
    """Periods of a neighbour, and what leads on from it: a line to the point, and its own motion.

    None where its period is no whole number of those of the structure, or where its laws are not
    those of the structure: some values, such as a clearance of 0, leave out a law.
    """
    if near is None or near.meshes % structure.meshes:
        return []
    if len(near.guess.values) != structure.problem.values:
        return []
    times, ahead = near.meshes // structure.meshes, near.towards(point)
    every = [ahead] if ahead is near.guess else [ahead, near.guess]
    return [(times, guess) for guess in every]
