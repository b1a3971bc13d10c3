"""A periodic motion by shooting: Newton on where the condensed core is a period later.

    q(T; q0, T) = q0,    theta(T; q0, T) = theta0 + turn

with the coordinates q0 and the period T unknown, as the speed follows from what drives and loads;
theta0 is where it begins, which may be anywhere (H. B. Keller, Numerical Methods for Two-Point
Boundary-Value Problems, 1968). Harmonics do not appear, so that teeth may separate as they like,
and whether a motion is stable does not matter. The derivative over q0, less what a later end makes
up for, has the Floquet multipliers as eigenvalues.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.floquet import Multipliers
from herringbone.analysis.steady.harmonic_balance.orbit import Motion
from herringbone.analysis.steady.harmonic_balance.problem import in_parts
from herringbone.analysis.steady.marching.march import March
from herringbone.analysis.steady.marching.marched import mean_turn
from herringbone.analysis.steady.marching.period_map import Course, Ended, PeriodMap
from herringbone.analysis.steady.structure import Structure
from herringbone.core import HerringboneError
from herringbone.core.process.one_thread import one_blas_thread

_MOST, _HALVINGS = 12, 5
"""Rounds of Newton, and how often a step of it is halved."""
_PLACES = 64
"""Of a mesh period, at which swings are looked at."""
_LONGEST, _AT = 50e-6, 1e-3
"""Base step [s] for a tolerance; its error falls with the third power."""
_FEWEST = 16
"""Base steps of a mesh period."""
_DIFFERENCE, _FARTHEST, _LEAST = 1e-4, 1e6, 1e-9
"""Of a derivative: change of a deflection, over its swing; that of a coordinate, over its swing, to
which this may lead; and over its size, below which it would be rounding."""


class Shot(NamedTuple):
    """A periodic motion.

    Attributes:
        begin: (coordinates,) at its start, see `period_map.Ended`.
        period: [s].
        missed: by how much outputs missed their start after a period, over the alternating part of
            the worst group of channels, before the last step.
        rounds: of Newton, before that.
        multipliers: Floquet multipliers.
    """

    begin: np.ndarray
    period: float
    missed: float
    rounds: int
    multipliers: Multipliers


class Shooting:
    """Shooting from guesses of one motion.

    Args:
        structure: the system; something holds its speed.
        motion: what is given of a period.
        meshes: mesh periods in it.
        tolerance: error of the alternating part of each group of channels.
        share: of the steps that are likely to do for it.
    """

    def __init__(
        self,
        structure: Structure,
        motion: Motion,
        meshes: int,
        tolerance: float,
        share: float = 1.0,
    ) -> None:
        self._structure, self._motion, self._meshes = structure, motion, meshes
        self._longest = share * _LONGEST * (tolerance / _AT) ** (1.0 / 3.0)
        self._fewest = _FEWEST / share
        self._map: PeriodMap | None = None

    @one_blas_thread()
    def shot(self, begin: np.ndarray, period: float, close: float) -> Shot | None:
        """The motion from a guess; None if there is none, or the iteration does not come to one.

        Args:
            begin: (coordinates,) at its start.
            period: its length [s].
            close: what may be missed after a period, see `Shot.missed`, and the last step.
        """
        longest = min(self._longest, period / self._meshes / self._fewest)
        self._map = PeriodMap(self._structure, self._motion, longest)
        try:
            return self._newton(begin, period, close)
        except (HerringboneError, np.linalg.LinAlgError):  # a march fails, or all is singular
            return None

    def _newton(self, x: np.ndarray, period: float, close: float) -> Shot | None:
        assert self._map is not None
        turn = np.copysign(self._motion.turn, self._map.end(x, period).x[-1] - x[-1])
        end, off, course = self._missed(x, period, turn)
        for rounds in range(_MOST + 1):
            missed = self._size(off, course)
            jacobian = self._map.jacobian(x, period, self._steps(x, course), end.x)
            step, longer = self._step(jacobian, end, off, course)
            if missed <= close and self._size(step, course) <= close:  # where little dies out, more
                x, period = x + step, period + longer
                return Shot(x, period, missed, rounds, self._multipliers(jacobian, end))
            for halving in range(_HALVINGS + 1):
                part = 0.5**halving
                try:
                    after = self._missed(x + part * step, period + part * longer, turn)
                except HerringboneError:
                    continue
                if self._size(after[1], course) < missed:
                    break
            else:
                return None
            x, period = x + part * step, period + part * longer
            end, off, course = after
        return None

    def _missed(
        self, x: np.ndarray, period: float, turn: float
    ) -> tuple[Ended, np.ndarray, Course]:
        """The end of a period, by how much it misses the start, and the way."""
        assert self._map is not None
        end = self._map.end(x, period)
        off = end.x - x
        off[-1] -= turn
        return end, off, self._map.along(x, period, _PLACES * self._meshes)

    def _steps(self, x: np.ndarray, course: Course) -> np.ndarray:
        """(coordinates,) of differences: they move no deflection of a law by more than a little.

        Swings of coordinates say less: some hardly move, and would have to by a million times as
        much before a law felt it, so that differences would be rounding.
        """
        problem = self._structure.problem
        rows = np.hstack([in_parts(problem.along), problem.along_angle[:, None]])
        moved = np.abs(rows) / np.ptp(rows @ _swinging(course).T, axis=1)[:, None]
        most = np.nan_to_num(moved, posinf=0.0).max(axis=0, initial=0.0)
        swing = _swing(course)
        farthest = np.maximum(_FARTHEST * swing, swing.max()) + np.finfo(float).tiny
        steps = _DIFFERENCE / np.maximum(most, 1.0 / farthest)
        return np.maximum(steps, _LEAST * np.abs(x))

    def _size(self, off: np.ndarray, course: Course) -> float:
        """What is missed of outputs, over the alternating part of the worst group of channels."""
        groups, rows = self._structure.groups
        matrix = np.hstack([in_parts(rows.modal), rows.of_angle[:, None]])
        swung = (matrix @ _swinging(course).T).var(axis=1)
        missed = (matrix @ off) ** 2
        found = [
            float(np.sqrt(missed[own].sum() / swung[own].sum()))
            for own in groups.values()
            if swung[own].sum() > 0.0
        ]
        return max(found, default=0.0)

    def _step(
        self, jacobian: np.ndarray, end: Ended, off: np.ndarray, course: Course
    ) -> tuple[np.ndarray, float]:
        """Newton's change of the beginning (coordinates,), and of the period [s]."""
        assert self._map is not None
        moving = self._map.moving
        rows = np.append(moving, off.size - 1)
        matrix = np.column_stack([jacobian[rows], end.rate[rows]])
        matrix[np.arange(moving.size), np.arange(moving.size)] -= 1.0
        swing = np.maximum(_swing(course), np.finfo(float).tiny)[moving]
        sizes = np.append(swing, 1.0 / abs(end.rate[-1]))
        over = np.append(swing, 1.0)
        scaled = matrix * sizes / over[:, None]
        found = sizes * np.linalg.lstsq(scaled, -off[rows] / over, rcond=None)[0]
        step = np.zeros_like(off)
        step[moving] = found[:-1]
        return step, float(found[-1])

    def _multipliers(self, jacobian: np.ndarray, end: Ended) -> Multipliers:
        """Of deviations at the angle at which the period ends."""
        assert self._map is not None
        later = np.outer(end.rate / end.rate[-1], jacobian[-1])
        found = np.linalg.eigvals((jacobian - later)[self._map.moving])
        return Multipliers(found[np.argsort(-np.abs(found))], 1)

    def march(self, found: Shot, places: int) -> March:
        """A period of what was found, at places of it; raises CoreStopped."""
        assert self._map is not None
        course = self._map.along(found.begin, found.period, places)
        frequency = 2.0 * np.pi / found.period
        turn = np.copysign(self._motion.turn, course.x[-1, -1] - course.x[0, -1])
        turned = mean_turn(course.x[:, -1:], turn / places)
        speed = turn / found.period
        return March(course.values, places, turned, speed, frequency, found.begin)


def _swinging(course: Course) -> np.ndarray:
    """(places, coordinates) less means, and theta less its growth."""
    x = course.x.copy()
    places = len(x)
    x[:, -1] -= np.arange(places) * (x[-1, -1] - x[0, -1]) / (places - 1)
    return x - x.mean(axis=0)


def _swing(course: Course) -> np.ndarray:
    """(coordinates,) how far they go, a pair of real and imaginary part alike."""
    swing = np.ptp(_swinging(course), axis=0)
    m = (swing.size - 1) // 2
    pair = np.hypot(swing[:m], swing[m : 2 * m])
    return np.concatenate([pair, pair, swing[2 * m :]])
