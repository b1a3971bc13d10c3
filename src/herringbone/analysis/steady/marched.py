"""A first guess of a periodic motion: the condensed core, marched for a while from the mean motion.

Where the run-outs of a gear open its teeth unless its shaft follows them, and where teeth separate,
Newton from a motion at rest may go astray. A march does not, and takes milliseconds.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
from herringbone.analysis.steady.structure import Structure
from herringbone.analysis.twin.condensed.equations import laws_of
from herringbone.analysis.twin.condensed.march_arrays import Calls
from herringbone.analysis.twin.condensed.solution import Solution
from herringbone.analysis.twin.condensed.system import Condensed

_DEGREE, _CLOSE = 3, 1e-3
_LONGEST = 100e-6
"""Longest base step [s]."""
_MOST_TIMES = 4
"""Most periods after which a march may repeat."""


@dataclass(frozen=True)
class Held(Condensed):
    """A condensed system after all ramps, with constant signals (signals,).

    Attributes:
        constant: these signals.
        ramp: turns over which what comes in over an angle still does.
    """

    constant: np.ndarray
    ramp: float = 0.0

    def signals(self, t: float) -> np.ndarray:
        """Signals of the sources at a time [s]."""
        del t
        return self.constant

    @property
    def curved(self) -> bool:
        """True: constants are curves."""
        return True

    def calls(self) -> Calls:
        """Addresses, and fresh blocks."""
        found = super().calls()
        first = self.twin.layout.block_first
        for p in self.equations.laws:
            laws = laws_of(self.twin.instances[p])
            assert laws is not None
            block = found.blocks[first[p] : first[p + 1]]
            laws.settle(block)
            if self.ramp:
                laws.ramp(block, self.ramp)
        return found


def start_of(orbit: Orbit) -> np.ndarray:
    """Real parts of modal coordinates, imaginary parts, and theta, at the start of the period."""
    q = orbit.q.ahead.sum(axis=1) + orbit.q.back[:, 1:].sum(axis=1)
    angle = (orbit.angle[0] + 2.0 * orbit.angle[1:].sum()).real
    return np.concatenate([q.real, q.imag, [angle]])


class March(NamedTuple):
    """The laws' values, less mean tangents, over the last periods of a march.

    Attributes:
        values: (values, kept places) at equal times.
        places: of a period.
        turned: theta at the first of them, less that at the start of a period [rad].
        speed, frequency: of the motion that it began from [rad/s].
    """

    values: np.ndarray
    places: int
    turned: float
    speed: float
    frequency: float

    def harmonics(self, periods: int) -> np.ndarray:
        """Coefficients (values, harmonics) over the last periods."""
        size, skipped = periods * self.places, self.values.shape[1] - periods * self.places
        found = np.fft.rfft(self.values[:, skipped:], axis=1)[:, : size // 2] / size
        begun = self.turned / self.speed + 2.0 * np.pi * skipped / (self.places * self.frequency)
        turning = np.arange(size // 2) * self.frequency / periods
        return found * np.exp(-1j * turning * begun)

    def lines(self, orders: np.ndarray) -> np.ndarray:
        """Coefficients (values, orders) of the period, ascending from 0, by least squares."""
        step = 2.0 * np.pi / (self.places * self.frequency)
        since = self.turned / self.speed + np.arange(self.values.shape[1]) * step
        turning = np.exp(1j * np.outer(since, orders[1:]) * self.frequency)
        known = np.hstack([np.ones((since.size, 1)), 2.0 * turning.real, -2.0 * turning.imag])
        found = np.linalg.lstsq(known, self.values.T, rcond=None)[0].T
        count = orders.size
        return found[:, :count] + 1j * np.pad(found[:, count:], ((0, 0), (1, 0)))

    def change(self, periods: int) -> float:
        """How far the last period is from the one some periods before, over its alternation."""
        size = self.values.shape[1]
        last = self.values[:, size - self.places :]
        shift = periods * self.places
        earlier = self.values[:, size - self.places - shift : size - shift]
        spread = np.linalg.norm(last - last.mean(axis=1, keepdims=True))
        return float(np.linalg.norm(last - earlier) / spread) if spread else 0.0

    def likely(self, least: float) -> list[int]:
        """Numbers of periods after which it may repeat, the likeliest first.

        Args:
            least: change that counts as none.
        """
        changes = {times: self.change(times) for times in range(1, _MOST_TIMES + 1)}
        return sorted(changes, key=lambda times: (changes[times] > least, times))

    @property
    def least(self) -> float:
        """The smallest change from one period to a later one."""
        return min(self.change(times) for times in range(1, _MOST_TIMES + 1))


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
    condensed, values = structure.core.condensed, structure.problem.values
    held = Held(
        condensed.twin, condensed.equations, condensed.modes, motion.given[:-1, 0].real.copy(), ramp
    )
    periods += ramp / abs(structure.turns_of_pinion)
    run = Solution(held, _DEGREE, _CLOSE, lean=True)
    own = start_of(begin)
    run.state.q[: own.size] = own
    gap = begin.period / places
    step = gap / np.ceil(gap / _LONGEST)
    count, last = round(kept * places), round(periods * places)
    times = structure.late + (np.arange(count) + last - count) * gap
    end = structure.late + last * gap
    found: list[np.ndarray] = []
    angle = 0.0
    for part in run.piece(structure.late, end, step, times):
        if not found:
            angle = float(part.held[0, 2 * condensed.modes.rates.size])
        inputs = part.held[:, run.state.q.size :: _DEGREE + 1]
        found.append(inputs[:, :values].copy())
    series = np.concatenate(found).T
    return March(series, places, angle, begin.response.speed, begin.response.frequency)
