"""Where the condensed core is a period later: the map whose fixed points are periodic motions.

Neutral modes (see `harmonic_balance.problem`) stay where they began: all else repeats beside them.

The propagator of the core is exact but for its laws, so that one period is a few dozen steps. Its
derivatives are differences of marches: what they cost is the number of coordinates times a period.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.orbit import Motion
from herringbone.analysis.steady.marching.marched import laws_values, marching
from herringbone.analysis.steady.structure import Structure

_CLOSE = 1e-9
"""Residual of the laws in a step: differences of marches must not see it."""


class Ended(NamedTuple):
    """The end of a period.

    Attributes:
        x: (coordinates,) real parts of the modal coordinates, imaginary parts, and theta [rad].
        rate: (coordinates,) of these [1/s].
    """

    x: np.ndarray
    rate: np.ndarray


class Course(NamedTuple):
    """A period at equal times.

    Attributes:
        values: (values, places) of the laws, less mean tangents.
        x: (places, coordinates), see `Ended`.
    """

    values: np.ndarray
    x: np.ndarray


class PeriodMap:
    """Marches over one period, from any coordinates on.

    Args:
        structure: the system.
        motion: what is given.
        longest: base step [s].
    """

    def __init__(self, structure: Structure, motion: Motion, longest: float) -> None:
        condensed = structure.core.condensed
        self._run = marching(structure, motion, _CLOSE, lean=False)
        self._modes, self._late, self._longest = condensed.modes, structure.late, longest
        self._values, self._begun = structure.problem.values, self._run.saved()
        self.size = 2 * self._modes.rates.size + self._modes.angles.size
        oscillating = self._modes.rates.imag != 0.0
        self._neutral, seen = list(structure.problem.neutral), np.ones_like(oscillating)
        seen[self._neutral] = False
        self.moving = np.flatnonzero(np.concatenate([seen, oscillating]))
        """Coordinates besides theta that are none but 0, and that others see."""

    def end(self, begin: np.ndarray, period: float) -> Ended:
        """Where it is after a period [s].

        Args:
            begin: (coordinates,), see `Ended`.
            period: its length.

        Raises:
            CoreStopped: the march fails.
        """
        for _ in self._pieces(begin, period, np.zeros(0)):
            pass
        x = self._run.state.q[: self.size].copy()
        count = self._run.degree + 1
        channels = self._run.state.u.reshape(-1, count)[:, -1]
        m = self._modes.rates.size
        q = x[:m] + 1j * x[m : 2 * m]
        rate = self._modes.rates * q + self._modes.inputs @ channels
        x[self._neutral], rate[self._neutral] = begin[self._neutral], 0.0
        turning = (self._modes.turns @ q).real
        return Ended(x, np.concatenate([rate.real, rate.imag, turning]))

    def along(self, begin: np.ndarray, period: float, places: int) -> Course:
        """A period [s] at places; raises CoreStopped."""
        times = self._late + np.arange(places) / places * period
        values, x = [], []
        for part in self._pieces(begin, period, times):
            values.append(laws_values(self._run, part)[: self._values])
            x.append(self._run.coordinates(part))
        found = Course(np.hstack(values), np.concatenate(x))
        found.x[:, self._neutral] = begin[self._neutral]
        return found

    def jacobian(
        self, begin: np.ndarray, period: float, steps: np.ndarray, end: np.ndarray
    ) -> np.ndarray:
        """(coordinates, moving): how the end (coordinates,) changes with the beginning.

        Args:
            begin, period: see `end`.
            steps: (coordinates,) of the differences.
            end: where the period ends.
        """
        found = np.empty((self.size, self.moving.size))
        for column, k in enumerate(self.moving):
            moved = begin.copy()
            moved[k] += steps[k]
            found[:, column] = (self.end(moved, period).x - end) / (moved[k] - begin[k])
        return found

    def _pieces(self, begin: np.ndarray, period: float, times: np.ndarray):  # noqa: ANN202
        self._run.put(self._begun)
        self._run.state.q[: self.size] = begin
        step = period / np.ceil(period / self._longest)
        return self._run.piece(self._late, self._late + period, step, times)
