"""The twin of a system of own parts by its condensed core.

Base steps of one length; polynomials of degree 3 through Lobatto nodes. Where a law bends (contact
begins or ends, the end of the damping gate, a limit), steps are halved down to 1 / 128.
"""

from collections.abc import Callable, Sequence
from copy import copy

import numpy as np

from herringbone.analysis.twin.condensed.equations import take_apart
from herringbone.analysis.twin.condensed.modes import make_modes
from herringbone.analysis.twin.condensed.solution import Solution
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core.process.activity import activity
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.structure.system import System

STEP = 5e-6
"""Longest base step [s]."""
DEGREE = 3
_SAME = 1e-9  # relative difference of lengths that are one: rounding of times


class CondensedTwin:
    """A system as one right-hand side, solved by its condensed core.

    Args:
        system: its parts are all components of this package.
        step: longest base step [s].
        degree: of the polynomials, see `rungs.LOBATTO`.

    Attributes:
        counts: steps taken, halvings, evaluations of the laws at all nodes, bends located.

    Raises:
        StructureError: the system has no condensed core; see `Twin` for all else.
    """

    def __init__(self, system: System, step: float = STEP, degree: int = DEGREE) -> None:
        self.twin = twin = Twin(system)
        self._step, self._degree = step, degree
        equations = take_apart(twin)
        with one_blas_thread():
            self._system = Condensed(twin, equations, make_modes(twin, equations))
        self.counts = np.zeros(4, dtype=np.int64)

    def with_step(self, step: float) -> "CondensedTwin":
        """The same twin with another longest base step [s]."""
        found = copy(self)
        found._step = step
        return found

    def solve(
        self,
        times: np.ndarray,
        columns: Sequence[str],
        progress: Callable[[float, float], None] | None = None,
    ) -> np.ndarray:
        """Outputs (times, columns) of the solution from the start values.

        Args:
            times: ascending, from 0 [s].
            columns: `instance.variable`.
            progress: called with the time reached and the end [s].

        Raises:
            HerringboneError: the laws have no solution in the shortest step, or it diverges.
        """
        t_end = float(times[-1])
        run = Solution(self._system, self._degree)
        t0, row = 0.0, 0
        values = np.empty((times.size, len(columns)))
        what = f"solving {self.twin.system.name} by its condensed core"
        one_thread = one_blas_thread()
        with one_thread, activity(what, shown=progress is not None):
            for t1 in [*self.twin.breakpoints(t_end), t_end]:
                last = t1 == t_end
                end = times.size if last else int(np.searchsorted(times, t1))
                step = self.base_step(t1 - t0, times)
                for samples in run.piece(t0, t1, step, times[row:end]):
                    here = slice(row, row + samples.times.size)
                    values[here] = self.twin.observe(times[here], run.states(samples), columns)
                    row = here.stop
                    if progress:
                        progress(float(times[row - 1]), t_end)
                t0 = t1
        self.counts = run.state.counted
        return values

    def base_step(self, length: float, times: np.ndarray) -> float:
        """A step that divides the length of a piece, and the distance of even times [s]."""
        gaps = np.diff(times)
        if gaps.size and np.ptp(gaps) <= _SAME * gaps[0]:
            even = float(gaps[0]) / np.ceil(gaps[0] / self._step * (1.0 - _SAME))
            count = length / even
            if abs(count - round(count)) <= _SAME * count:
                return length / round(count)
        return length / np.ceil(length / self._step * (1.0 - _SAME))
