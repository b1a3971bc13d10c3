"""Steady states of one system at many operating points."""

from collections.abc import Mapping

import numpy as np
from threadpoolctl import ThreadpoolController

from herringbone.analysis.steady.accuracy import Accuracy, accuracy
from herringbone.analysis.steady.balance import Balance, Motion, Orbit, Period
from herringbone.analysis.steady.set_points import Point
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.steady.structure import Structure
from herringbone.core import ParameterError
from herringbone.cosim.structure.system import System

TOLERANCE = 1e-3
AS_IT_IS = Point()
_BLAS = ThreadpoolController()
_PLACES, _MOST_PLACES = 64, 2048
"""Points in time of a mesh period: at first, and at most."""


class SteadySolver:
    """Periodic steady states of a system, prepared once.

    Set points (speed and torque) change nothing that was prepared. Values that do not change the
    linear part, such as those of the contact, prepare the laws alone again; of any other the system
    is taken apart again.

    Args:
        system: with start values of steady rotation, see `running.prepared`; its parts are all
            components of this package.
        tolerance: error of the alternating part of each group of channels.

    Raises:
        ParameterError: the tolerance is none.
        StructureError: the system cannot be taken apart, or its motion does not repeat.
    """

    def __init__(self, system: System, tolerance: float = TOLERANCE) -> None:
        if not 0.0 < tolerance < 1.0:
            raise ParameterError(f"tolerance = {tolerance:g}: it must lie between 0 and 1")
        self._system, self.tolerance = system, tolerance
        self._structure = Structure(system)
        self._values: Mapping[str, float | str] = {}

    def solve(self, point: Point = AS_IT_IS, near: SteadyState | None = None) -> SteadyState:
        """The steady state at an operating point.

        Args:
            point: what differs from the system as it is.
            near: the state at a point nearby, to begin from; from equilibrium if not given.

        Returns:
            A state; ask it whether it is `converged`.

        Raises:
            ParameterError: the system declares no such set point.
        """
        with _BLAS.limit(limits=1, user_api="blas"):
            structure = self._at(point)
            orbit, errors = self._resolved(structure, point, near)
        return SteadyState(structure, point, orbit, errors, self.tolerance)

    def _at(self, point: Point) -> Structure:
        """The structure with the values of a point."""
        values = self._structure.points.values(point)
        if values != self._values:
            self._structure = Structure(self._system.with_values(values), self._structure)
            self._values = values
        return self._structure

    def _resolved(
        self, structure: Structure, point: Point, near: SteadyState | None
    ) -> tuple[Orbit, Accuracy]:
        """A motion with as many harmonics as the tolerance needs."""
        motion, places, start = _motion(structure, point), _PLACES, structure.start
        if near is not None and near.meshes == structure.meshes:
            start, places = _values_of(near.orbit, structure), near.orbit.places
        while True:
            balance = Balance(structure.problem, Period(places // 4, places), motion)
            orbit = balance.solve(start, self.tolerance)
            errors = accuracy(structure, motion, orbit)
            if not orbit.converged or errors.worst <= self.tolerance or places >= _MOST_PLACES:
                return orbit, errors
            start, places = _values_of(orbit, structure), 2 * places


def _values_of(orbit: Orbit, structure: Structure) -> np.ndarray:
    return orbit.channels[: structure.problem.values]


def _motion(structure: Structure, point: Point) -> Motion:
    """What is given of the motion at an operating point."""
    condensed, problem = structure.core.condensed, structure.problem
    signals = structure.points.signals(condensed, structure.late, point)
    given = np.append(signals, 1.0)[:, None].astype(complex)
    speed = 0.0
    if problem.free is not None:
        speed = float((problem.turns @ condensed.modes.start).real)
        if point.speed is not None:
            speed = point.speed * structure.turn / (2.0 * np.pi * structure.turns_of_pinion)
    return Motion(given, structure.turn, speed, angle=float(condensed.modes.angles[0]))
