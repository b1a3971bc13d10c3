"""Steady states of one system at many operating points."""

from collections.abc import Mapping

import numpy as np

from herringbone.analysis.steady.accuracy import Accuracy, accuracy
from herringbone.analysis.steady.balance import Balance
from herringbone.analysis.steady.marched import marched
from herringbone.analysis.steady.orbit import Motion, Orbit, Period
from herringbone.analysis.steady.set_points import Point
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.steady.structure import Structure
from herringbone.core import ParameterError
from herringbone.core.one_thread import one_blas_thread
from herringbone.cosim.structure.system import System

TOLERANCE = 1e-3
AS_IT_IS = Point()
_PLACES, _MOST_PLACES = 64, 2048
"""Points in time of a mesh period: at first, and at most."""
_SLOW, _SLOW_THIN, _SAME = 6, 1e-3, 1e-2
"""Of a first guess: points in time for each mesh, alternation that is not in use, last change."""
_THIN = 0.05
"""Alternating part of the contact that harmonics may have that are not in use, over the tolerance:
at first, of many meshes."""
_THINNER = 0.3


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
        with one_blas_thread():
            structure = self._at(point)
            motion = _motion(structure, point)
            orbit, errors = self._resolved(structure, motion, near)
        return SteadyState(structure, point, motion, orbit, errors, self.tolerance)

    def _at(self, point: Point) -> Structure:
        """The structure with the values of a point."""
        values = self._structure.points.values(point)
        if values != self._values:
            self._structure = Structure(self._system.with_values(values), self._structure)
            self._values = values
        return self._structure

    def _resolved(
        self, structure: Structure, motion: Motion, near: SteadyState | None
    ) -> tuple[Orbit, Accuracy]:
        """A motion with as many harmonics as the tolerance needs."""
        meshes, problem = structure.meshes, structure.problem
        per_mesh = _PLACES
        if near is not None and near.meshes == meshes:
            start, known = near.orbit.channels[: problem.values], near.orbit.response.orders
            per_mesh = near.orbit.places // meshes
        else:
            start, known = _begun(structure, motion, per_mesh)
        thin = _THIN * self.tolerance
        while True:
            period = Period(per_mesh // 4, meshes * per_mesh, meshes, thin)
            orbit = Balance(problem, period, motion).solve(start, known, self.tolerance)
            errors = accuracy(structure, period, motion, orbit)
            if not orbit.converged or errors.worst <= self.tolerance or per_mesh >= _MOST_PLACES:
                return orbit, errors
            start, known = orbit.channels[: problem.values], orbit.response.orders
            if errors.by_thinning:
                thin *= _THINNER * self.tolerance / errors.worst
            else:
                per_mesh *= 2


def _begun(structure: Structure, motion: Motion, per_mesh: int) -> tuple[np.ndarray, np.ndarray]:
    """A first guess of the values' harmonics, and their orders."""
    meshes, problem = structure.meshes, structure.problem
    still = Balance(problem, Period(0, 1), motion)
    found = still.solve(structure.start, np.zeros(1, dtype=int), _SAME)
    if meshes == 1:
        return found.channels[: problem.values], found.response.orders
    places = _slow_places(meshes)
    values = marched(structure, motion, found, 1, places)
    slow = Balance(problem, Period(0, places, meshes, _SLOW_THIN), motion)
    found = slow.solve(values, np.arange(values.shape[1]), _SAME)
    return found.channels[: problem.values], found.response.orders


def _slow_places(meshes: int) -> int:
    """Points in time of a period that meet the mesh at ever new phases."""
    return 1 << int(np.ceil(np.log2(_SLOW * meshes)))


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
