"""A first guess of a periodic motion: the condensed core, marched for a while from the mean motion.

Where the run-outs of a gear open its teeth unless its shaft follows them, and where teeth separate,
Newton from a motion at rest may go astray. A march does not, and takes milliseconds.
"""

import numpy as np

from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
from herringbone.analysis.steady.marching.held import Held
from herringbone.analysis.steady.marching.march import March
from herringbone.analysis.steady.structure import Structure
from herringbone.analysis.twin.condensed.march_arrays import Samples
from herringbone.analysis.twin.condensed.rungs import coefficients
from herringbone.analysis.twin.condensed.solution import Solution

_DEGREE, _CLOSE = 3, 1e-3
"""Of steps, and the residual whose correction solves one: half a step begins so much nearer to its
solution that what is left falls with the steps' own error."""
_LONGEST = 100e-6
"""Longest base step [s]."""
_SAME = 1e-10
"""Change of a period that is rounding."""


def start_of(orbit: Orbit) -> np.ndarray:
    """Real parts of modal coordinates, imaginary parts, and theta, at the start of the period."""
    every = np.vstack([orbit.q, orbit.angle])
    return (every[:, 0] + 2.0 * every[:, 1:].sum(axis=1)).real


def marching(
    structure: Structure, motion: Motion, close: float, *, lean: bool, ramp: float = 0.0
) -> Solution:
    """A march of the condensed core under what is given of a motion.

    Args:
        structure: the system.
        motion: what is given.
        close, lean: see `Solution`.
        ramp: turns of the first pinion over which deviations come in.
    """
    known, constant = structure.core.condensed, motion.given[:-1, 0].real.copy()
    held = Held(known.twin, known.equations, known.modes, constant, ramp)
    return Solution(held, _DEGREE, close, lean=lean)


def laws_values(run: Solution, part: Samples) -> np.ndarray:
    """Channels (channels, times) of a march, the laws' values less mean tangents first.

    Along the polynomials of its steps.
    """
    nodes = part.held[:, run.state.q.size :].reshape(part.times.size, -1, _DEGREE + 1)
    shares = (part.since / part.length)[:, None] ** np.arange(_DEGREE + 1)
    return np.einsum("tvn,tn->vt", nodes, shares @ coefficients(_DEGREE))


class Following:
    """The condensed core on its way from a motion on, place by place of the period.

    The period is that in which theta turns as it should: after each whole one that was marched it
    is taken anew, as where torques decide on the speed, what vibrates has a say in it.

    Args:
        structure: the system.
        motion: what is given.
        begin: where it begins; the first period is its own.
        places: points in time of a period.
        ramp: turns of the first pinion over which deviations come in.

    Attributes:
        period: [s].
        time: how long it has gone on [s].
    """

    def __init__(
        self, structure: Structure, motion: Motion, begin: Orbit, places: int, ramp: float = 0.0
    ) -> None:
        self._begun = structure, motion, begin, places, ramp
        self._condensed, self._values = structure.core.condensed, structure.problem.values
        self._run = marching(structure, motion, _CLOSE, lean=True, ramp=ramp)
        own = start_of(begin)
        self._run.state.q[: own.size] = own
        self._late, self._turn = structure.late, np.copysign(motion.turn, begin.response.speed)
        self.places, self.period, self.time, self._parts = places, begin.period, 0.0, 1

    @property
    def _theta(self) -> float:
        """The angle that has grown [rad]; 0 where nothing turns."""
        rates, angles = self._condensed.modes.rates, self._condensed.modes.angles
        return float(self._run.state.q[2 * rates.size]) if angles.size else 0.0

    def halve(self) -> None:
        """Go on with steps of half the length: they still meet knots of tables as they did."""
        self._parts *= 2

    def anew(self) -> "Following":
        """One that begins as this one did, by the steps of now."""
        found = Following(*self._begun)
        found._parts = self._parts
        return found

    def settle(self, time: float) -> None:
        """Go on for a time [s] from the beginning, and before it while deviations come in."""
        structure, _, begin, _, ramp = self._begun
        turned = ramp / abs(structure.turns_of_pinion)
        self.on(int(np.ceil((turned + time / begin.period) * self.places)), 1)

    def on(self, places: int, kept: int, inside: int = 1) -> March:
        """Go on for some places, and keep the last ones.

        Args:
            places: how many.
            kept: of them, at least one.
            inside: values kept for each place, a power of 2: along the polynomials of the steps.

        Raises:
            CoreStopped: the march fails.
        """
        gap, begin, theta = self.period / self.places, self._late + self.time, self._theta
        end = begin + places * gap
        times = end + (np.arange(kept * inside) / inside - kept) * gap
        step = gap / (np.ceil(gap / _LONGEST) * self._parts)
        series, angles = [np.zeros((self._values, 0))], [np.zeros(0)]
        for part in self._run.piece(begin, end, step, times):
            series.append(laws_values(self._run, part)[: self._values])
            coarse = Samples(*(array[::inside] for array in part))
            angles.append(self._run.coordinates(coarse)[:, 2 * self._condensed.modes.rates.size :])
        self.time += places * gap
        found = self._march(np.hstack(series), np.concatenate(angles[1:]), self.places * inside)
        if places % self.places == 0 and self._turn:
            self._take_period(self._turn * (places * gap) / (self._theta - theta))
        return found

    def _take_period(self, period: float) -> None:
        """Take another one [s], if it is not the same."""
        if abs(period - self.period) > _SAME * self.period:
            self.period = period

    def _march(self, series: np.ndarray, angles: np.ndarray, places: int) -> March:
        """What was kept; the first of it where theta, but for its swing, is as far as it is."""
        modes, speed = self._condensed.modes, self._turn / self.period
        turned = mean_turn(angles, self.period / self.places * speed) if modes.angles.size else 0.0
        end = self._run.state.q[: 2 * modes.rates.size + modes.angles.size].copy()
        return March(series, places, turned, speed, 2.0 * np.pi / self.period, end)


def mean_turn(angles: np.ndarray, grown: float) -> float:
    """theta [rad] at the first of equal times, without its swing.

    Args:
        angles: (times, 1) theta, over whole periods.
        grown: by how much it grows from one to the next, in the mean.
    """
    return float((angles[:, 0] - grown * np.arange(len(angles))).mean())


def marched(
    structure: Structure,
    motion: Motion,
    begin: Orbit,
    periods: float,
    places: int,
    kept: float = 1.0,
    ramp: float = 0.0,
) -> March:
    """March for a while.

    Args:
        structure: the system.
        motion: what is given.
        begin: where it begins.
        periods: its length.
        places: points in time of a period.
        kept: periods that are kept.
        ramp: turns of the first pinion, before all that, over which deviations come in.

    Raises:
        CoreStopped: the march fails.
    """
    way = Following(structure, motion, begin, places, ramp)
    periods += ramp / abs(structure.turns_of_pinion)
    return way.on(round(periods * places), round(kept * places))
