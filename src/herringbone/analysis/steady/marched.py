"""A first guess of a periodic motion: the condensed core, marched for a while from the mean motion.

Where the run-outs of a gear open its teeth unless its shaft follows them, and where teeth separate,
Newton from a motion at rest may go astray. A march does not, and takes milliseconds.
"""

from dataclasses import dataclass

import numpy as np

from herringbone.analysis.steady.orbit import Motion, Orbit
from herringbone.analysis.steady.structure import Structure
from herringbone.analysis.twin.condensed.equations import laws_of
from herringbone.analysis.twin.condensed.march_arrays import Calls
from herringbone.analysis.twin.condensed.solution import Solution
from herringbone.analysis.twin.condensed.system import Condensed

_DEGREE, _CLOSE = 3, 1e-3
_LONGEST = 100e-6
"""Longest base step [s]."""


@dataclass(frozen=True)
class Held(Condensed):
    """A condensed system after all ramps, with constant signals (signals,)."""

    constant: np.ndarray

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
            laws.settle(found.blocks[first[p] : first[p + 1]])
        return found


def start_of(orbit: Orbit) -> np.ndarray:
    """Real parts of modal coordinates, imaginary parts, and theta, at the start of the period."""
    q = orbit.q.ahead.sum(axis=1) + orbit.q.back[:, 1:].sum(axis=1)
    angle = (orbit.angle[0] + 2.0 * orbit.angle[1:].sum()).real
    return np.concatenate([q.real, q.imag, [angle]])


def marched(
    structure: Structure, motion: Motion, begin: Orbit, periods: int, places: int
) -> np.ndarray:
    """Harmonics of the laws' values, less mean tangents, over the last period of a march.

    Args:
        structure: the system.
        motion: what is given.
        begin: where it begins.
        periods: its length.
        places: points in time of the period.

    Returns:
        (values, places // 2) coefficients.

    Raises:
        CoreStopped: the march fails.
    """
    condensed, values = structure.core.condensed, structure.problem.values
    held = Held(
        condensed.twin, condensed.equations, condensed.modes, motion.given[:-1, 0].real.copy()
    )
    run = Solution(held, _DEGREE, _CLOSE, lean=True)
    own = start_of(begin)
    run.state.q[: own.size] = own
    gap = begin.period / places
    step = gap / np.ceil(gap / _LONGEST)
    times = structure.late + (np.arange(places) + (periods - 1) * places) * gap
    end = structure.late + periods * places * gap
    found, angle = [], None
    for part in run.piece(structure.late, end, step, times):
        if angle is None:
            angle = float(part.held[0, 2 * condensed.modes.rates.size])
        inputs = part.held[:, run.state.q.size :: _DEGREE + 1]
        found.append(inputs[:, :values].copy())
    harmonics = np.fft.rfft(np.concatenate(found), axis=0)[: places // 2].T / places
    turned = (angle or 0.0) / begin.response.speed  # it does not begin at the angle of a period
    k = np.arange(places // 2)
    return harmonics * np.exp(-1j * k * begin.response.frequency * turned)
