"""One solution of a condensed system, piece by piece between breakpoints."""

from collections.abc import Iterator

import numpy as np

from herringbone.analysis.twin.condensed.march import (
    DONE,
    NOT_CONVERGED,
    begin,
    call_sources,
    march,
)
from herringbone.analysis.twin.condensed.march_arrays import Fixed, Samples, State
from herringbone.analysis.twin.condensed.rungs import (
    LOBATTO,
    Rungs,
    coefficients,
    make_rungs,
    powers,
    twice,
)
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.core import HerringboneError
from herringbone.kernels.condensed.collocation import Nodes

HALVINGS = 7
"""Rungs below the base step."""
_AT_ONCE = 4096  # times that are kept by one call of the march
_GRID = 1e-9  # of a step: a time this close to its start is its start


class Solution:
    """A march from the start values on.

    Attributes:
        state: where it stands.
    """

    def __init__(self, system: Condensed, degree: int) -> None:
        self._system, self._degree = system, degree
        self._modes = modes = system.modes
        self._calls = calls = system.calls()
        self._table = system.table(calls)
        self._nodes = Nodes(
            np.zeros((degree, calls.argument[-1])),
            np.zeros((degree, calls.value[-1])),
            np.zeros((degree, calls.tangent[-1])),
            np.ones((degree + 1, calls.indicator[-1])),
        )
        nodes = np.array(LOBATTO[degree])
        offset = float(np.any(modes.inputs[:, -1]) or np.any(modes.of_channels[:, -1]))
        self._fixed = Fixed(
            modes.of_angles, modes.of_angles @ modes.angles, _ahead(degree), nodes, offset
        )
        self.state = State(
            np.ascontiguousarray(modes.start.real),
            np.ascontiguousarray(modes.start.imag),
            np.zeros_like(modes.angles),
            np.zeros(system.equations.channels * (degree + 1)),
            np.array([0, 0, 0, -1]),
            np.zeros(3, dtype=np.int64),
        )
        self._rungs: dict[float, Rungs] = {}

    def piece(self, t0: float, t1: float, h: float, wanted: np.ndarray) -> Iterator[np.ndarray]:
        """States (n, times) at the wanted times of a piece [s], some thousand at once.

        Args:
            t0, t1: its ends.
            h: base step, which divides it; any if it is empty.
            wanted: times in it, ascending.

        Raises:
            HerringboneError: the laws have no solution in the shortest step, or it diverges.
        """
        if t1 <= t0:
            yield self._modes.states(
                *(
                    np.tile(now, (wanted.size, 1))
                    for now in (self.state.x, self.state.y, self.state.angle)
                )
            )
            return
        rungs = self._rungs_of(h)
        self.state.place[:] = 0, 0, 0, -1
        self._begin(t0)
        for first in range(0, max(wanted.size, 1), _AT_ONCE):
            chunk = wanted[first : first + _AT_ONCE]
            # With a time that never comes the march goes on to the end of the piece.
            whole = chunk if first + _AT_ONCE < wanted.size else np.append(chunk, np.inf)
            samples = self._room(whole)
            status = march(
                self._calls, self._fixed, rungs, self._table, self._nodes, self.state, samples,
                t0, round((t1 - t0) / h),
            )  # fmt: skip
            if status != DONE:
                self._fail(status, t0, rungs)
            yield self._states(samples, chunk.size)

    def _rungs_of(self, h: float) -> Rungs:
        if h not in self._rungs:
            lengths = [h / 2**k for k in range(HALVINGS + 1)]
            self._rungs[h] = make_rungs(
                self._modes, lengths, self._degree, self._system.directions, self._system.stiff
            )
        return self._rungs[h]

    def _begin(self, t: float) -> None:
        """The laws' inputs and indicators at the start of a piece, as if a step had ended there."""
        calls, modes, state = self._calls, self._modes, self.state
        call_sources(calls, t)
        channels = np.zeros(self._system.equations.channels)
        channels[calls.value[-1] : -1] = calls.blocks[calls.signal]
        channels[-1] = 1.0
        z = (modes.arguments @ (state.x + 1j * state.y)).real
        self._nodes.z[0] = (
            z + self._fixed.offset + modes.of_angles @ state.angle + modes.of_channels @ channels
        )
        begin(calls, self._table, self._nodes, state.u)

    def _room(self, times: np.ndarray) -> Samples:
        state, n = self.state, times.size
        return Samples(
            times,
            np.zeros((n, state.x.size)),
            np.zeros((n, state.x.size)),
            np.zeros((n, state.angle.size)),
            np.zeros((n, state.u.size)),
            np.zeros(n),
            np.ones(n),
        )

    def _states(self, samples: Samples, count: int) -> np.ndarray:
        """States (n, count) at the first times of the samples."""
        x, y, angle = samples.x[:count], samples.y[:count], samples.angle[:count]
        inside = np.flatnonzero(samples.since[:count] > _GRID * samples.length[:count])
        if inside.size:
            later = self._later(samples, inside)
            x[inside], y[inside], angle[inside] = later[0].T.real, later[0].T.imag, later[1].T
        return self._modes.states(x, y, angle)

    def _later(self, samples: Samples, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and angles (..., times) at times inside of steps."""
        modes, degree = self._modes, self._degree
        q = (samples.x[rows] + 1j * samples.y[rows]).T
        t, length = samples.since[rows], samples.length[rows]
        nodes = samples.u[rows].reshape(rows.size, -1, degree + 1)
        driven = np.einsum("jn,tkn->jkt", coefficients(degree), nodes)
        of_powers = modes.inputs @ driven  # powers, modes, times
        of_powers *= ((t / length) ** np.arange(degree + 1)[:, None])[:, None]
        once = powers(modes.rates[:, None], t[None, :], degree + 1)
        growth = once[0] * q + (twice(once, t) * of_powers).sum(axis=0)
        angle = samples.angle[rows].T + (modes.turns @ growth).real
        return np.exp(modes.rates[:, None] * t) * q + (once[:-1] * of_powers).sum(axis=0), angle

    def _fail(self, status: int, t0: float, rungs: Rungs) -> None:
        count, inside = self.state.place[:2]
        t = t0 + count * rungs.lengths[0] + inside * rungs.lengths[-1]
        why = "the laws have no solution" if status == NOT_CONVERGED else "a state is not finite"
        raise HerringboneError(
            f"the condensed twin stops at {t:g} s, in a step of {rungs.lengths[-1]:g} s: {why}"
        )


def _ahead(degree: int) -> np.ndarray:
    """Polynomials of a step, continued over one of 2^-d of its length, d from -HALVINGS on."""
    fit, nodes = coefficients(degree), np.array(LOBATTO[degree])
    shares = 2.0 ** -np.arange(-HALVINGS, HALVINGS + 1)
    return np.array([np.vander(1.0 + s * nodes, degree + 1, increasing=True) @ fit for s in shares])
