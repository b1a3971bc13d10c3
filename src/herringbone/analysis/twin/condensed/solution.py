"""One solution of a condensed system, piece by piece between breakpoints."""

from collections.abc import Iterator, Mapping
from functools import cache

import numpy as np

from herringbone.analysis.twin.condensed.at_times import coordinates
from herringbone.analysis.twin.condensed.march import (
    BASE,
    DONE,
    INSIDE,
    KEPT,
    NOT_CONVERGED,
    RUNG,
    RUNG_WANTED,
    begin,
    march,
)
from herringbone.analysis.twin.condensed.march_arrays import (
    Arrays,
    Asked,
    Fixed,
    Samples,
    State,
    Work,
)
from herringbone.analysis.twin.condensed.rungs import (
    LOBATTO,
    Rungs,
    Shape,
    continued,
    midway,
)
from herringbone.analysis.twin.condensed.step_matrices import HALVINGS, StepMatrices
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.core import HerringboneError
from herringbone.core.declaring.variable import NODES
from herringbone.kernels.condensed.collocation import Nodes, Sharp
from herringbone.kernels.condensed.correction import make_room
from herringbone.kernels.condensed.lines import aligned, padded

CLOSE = 1e-8
"""Residual of the laws' values, over their size, whose correction solves a step.

Every correction makes it a thousand times smaller, or more, wherever no law bends."""
COARSE = 0.1
"""Such a residual from which on errors of 1e-3 are wanted: fine directions are left out then, and
single precision is enough for matrices, as long as no law bends."""
_SHORT = 1e-5
"""Base steps [s] so short that what single precision errs in each of them adds up."""
_LEAN_AHEAD = 2
"""Degree of the prediction over long steps, where a higher one goes farther off."""
_NEGLIGIBLE = 1e-5
"""Of `Fixed.close`: what a value moves a coordinate by, at most, to be left out of lean steps; 1e-3
of the tolerance, see `fused.core.closeness`."""
_AT_ONCE = 4096  # times that are kept by one call of the march


class CoreStopped(HerringboneError):
    """The laws have no solution in the shortest step, or a state is not finite.

    Attributes:
        time: at which it stops [s].
    """

    def __init__(self, message: str, time: float) -> None:
        super().__init__(message)
        self.time = time


class Solution:
    """A march from the start values on.

    Args:
        system: to be solved.
        degree: of the polynomials, see `rungs.LOBATTO`.
        close: see CLOSE.
        lean: see `march_arrays.Fixed`.

    Attributes:
        state: where it stands.
        matrices: of its steps.
    """

    def __init__(
        self, system: Condensed, degree: int, close: float = CLOSE, *, lean: bool = False
    ) -> None:
        self._system, self.degree = system, degree
        self._modes = modes = system.modes
        self._calls = calls = system.calls()
        self._table = system.table(calls)
        self._nodes = Nodes(
            aligned(degree, calls.argument[-1]),
            aligned(degree, calls.value[-1]),
            aligned(degree, calls.tangent[-1]),
            np.ones((degree + 1, calls.indicator[-1])),
            aligned(calls.argument[-1]),
        )
        self._corrections = make_room(len(system.stiff), degree, calls.tangent[-1])
        channels = system.equations.channels
        sharp, coarse = system.sharp, close >= COARSE
        if not coarse:
            sharp = np.concatenate([sharp, system.fine])
        self._shape = Shape(degree, lean, system.directions, sharp, system.stiff, lean and coarse)
        turned = np.broadcast_to(modes.of_angles @ modes.angles, (degree, calls.argument[-1]))
        self._fixed = Fixed(
            _filled(np.append(self._shape.rows(turned), np.zeros(2 * modes.angles.size))),
            _ahead(degree, _LEAN_AHEAD if lean else degree),
            np.array(LOBATTO[degree]),
            float(np.any(modes.inputs[:, -1]) or np.any(modes.of_channels[:, -1])),
            close,
            lean,
            Sharp.of(np.array(LOBATTO[degree]), sharp),
            midway(degree),
        )
        start = modes.start
        self.state = State(
            _filled(np.concatenate([start.real, start.imag, np.zeros_like(modes.angles)])),
            aligned(channels * (degree + 1)),
            np.zeros((len(system.equations.signals), 2 + NODES)),
            np.array([0, 0, 0, -1, 0, 0]),
            np.zeros(4, dtype=np.int64),
        )
        self._reference = np.zeros(channels)
        self._work = _room_of(self._fixed, self.state)
        self._held, self._lengths = np.zeros((0, 0)), np.zeros((2, 0))
        self.matrices = StepMatrices(system, self._shape, self._reference)

    @property
    def arrays(self) -> Arrays:
        """All that a march works on but matrices of steps and samples."""
        return Arrays(
            self._calls, self._fixed, self._table, self._nodes, self._corrections, self.state,
            self._work,
        )  # fmt: skip

    def saved(self) -> dict[str, np.ndarray]:
        """What is needed to go on with the same bits; copies."""
        copies = {name: array.copy() for name, array in self._remembered().items()}
        return {**copies, "short": np.array([self._shape.short])}

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """Go on from there."""
        for name, array in self._remembered().items():
            array[...] = saved[name]
        if self._shape.short != (short := bool(saved["short"][0])):
            self._make_matrices(short=short)
        self.matrices.renew()

    def _remembered(self) -> dict[str, np.ndarray]:
        nodes = self._nodes
        table = {"scale": self._table.scale, "least": self._table.least}
        return {
            **self.state._asdict(), **table, "indicators": nodes.e[0], "arguments": nodes.start,
            "reference": self._reference,
        }  # fmt: skip

    def enter(self, t0: float, t1: float) -> None:
        """Begin a piece [s]: what came before says nothing about the laws' inputs."""
        self.state.place[:] = 0, 0, 0, -1, 0, 0
        self._find_curves(t0, t1)
        self._begin(t0)

    def _find_curves(self, t0: float, t1: float) -> None:
        """Signals of a piece as parabolas over time, exact where they are curves."""
        half = 0.25 * (t1 - t0)
        since = t0 + 2.0 * half
        before, now, after = (self._system.signals(since + k * half) for k in (-1, 0, 1))
        curve = self.state.curve
        curve[:, 0], curve[:, 1] = since, now
        curve[:, 2:] = 0.0
        if half > 0.0:
            curve[:, 2] = 0.5 * ((after - now) - (before - now)) / half
            curve[:, 3] = 0.5 * ((after - now) + (before - now)) / half**2

    def piece(self, t0: float, t1: float, h: float, wanted: np.ndarray) -> Iterator[Samples]:
        """The steps around the wanted times of a piece [s], some thousand at once; see `part`.

        Args:
            t0, t1: its ends.
            h: base step, which divides it; any if it is empty.
            wanted: times in it, ascending.

        Raises:
            CoreStopped: the laws have no solution in the shortest step, or it diverges.
        """
        self.enter(t0, t1)
        for first in range(0, max(wanted.size, 1), _AT_ONCE):
            chunk = wanted[first : first + _AT_ONCE]
            whole = first + _AT_ONCE < wanted.size
            yield self.part(t0, t1, h, chunk if whole else np.append(chunk, np.inf))

    def part(self, t0: float, t1: float, h: float, wanted: np.ndarray) -> Samples:
        """The steps around some wanted times of a piece that was entered, after the last ones.

        A time that never comes, infinity, leads to the end of the piece; it is left out. They are
        good until the next call.

        Raises:
            CoreStopped: see `piece`.
        """
        samples, count = self._room(wanted), int(np.isfinite(wanted).sum())
        self.state.place[KEPT] = 0
        if t1 <= t0:
            samples.held[:] = np.concatenate([self.state.q, self._ends])
        else:
            asked = Asked(self.matrices.of(h), samples, t0, round((t1 - t0) / h))
            status = RUNG_WANTED
            while status == RUNG_WANTED:
                rung = int(self.state.place[RUNG])
                if self._shape.short and (rung > 0 or h < _SHORT):
                    self._make_matrices(short=False)
                    asked = asked._replace(rungs=self.matrices.of(h))
                self.matrices.make(asked.rungs, rung)
                status = march(self.arrays, asked)
            if status != DONE:
                self._fail(status, t0, asked.rungs)
        return Samples(*(array[:count] for array in samples))

    def reached(self, t0: float, h: float) -> float:
        """Time [s] up to which a piece from t0 on is done, in base steps h."""
        place = self.state.place
        return float(t0 + h * (place[BASE] + place[INSIDE] / 2**HALVINGS))

    def _make_matrices(self, *, short: bool) -> None:
        """In double precision once a step is halved, as where a law bends, and of short steps.

        Values far from those at the start of the piece, as of teeth apart, have to cancel what mean
        tangents stand for: single precision would err as a force does.
        """
        self._shape = self._shape._replace(short=short)
        self.matrices = StepMatrices(self._system, self._shape, self._reference)

    def _begin(self, t: float) -> None:
        """The laws' inputs and indicators at the start of a piece, as if a step had ended there."""
        calls, modes, state = self._calls, self._modes, self.state
        channels = np.zeros(self._system.equations.channels)
        channels[calls.value[-1] : -1] = self._system.signals(t)
        channels[-1] = 1.0
        m = modes.rates.size
        z = (modes.arguments @ (state.q[:m] + 1j * state.q[m : 2 * m])).real
        self._nodes.z[0] = (
            z
            + modes.of_angles @ (modes.angles + state.q[2 * m : 2 * m + modes.angles.size])
            + modes.of_channels @ channels
        )
        self._nodes.start[:] = self._nodes.z[0]
        begin(calls, self._table, self._nodes, t, state.u)
        self._reference[:] = channels
        self._reference[: calls.value[-1]] = state.u.reshape(channels.size, -1)[
            : calls.value[-1], -1
        ]
        self.matrices.renew()
        if self._fixed.lean:
            self._neglect()

    def _neglect(self) -> None:
        """Find what is left out of a piece, from the laws' values at its start."""
        table, stiff = self._table, list(self._system.stiff)
        moved = np.abs(self._modes.inputs)
        size = np.maximum(table.scale, np.abs(self._nodes.f[0]))
        by_stiff = (moved[:, stiff] * size[stiff]).max(axis=1, initial=0.0)
        for value in np.setdiff1d(np.arange(size.size), stiff):
            of_value = moved[:, value]
            felt = of_value > 0.0
            least = np.min(by_stiff[felt] / of_value[felt], initial=np.inf)
            table.least[value] = _NEGLIGIBLE * self._fixed.close * least if felt.any() else 0.0

    @property
    def _ends(self) -> np.ndarray:
        """Inputs of a step that stays where the last one ended."""
        ends = self.state.u.reshape(-1, self.degree + 1)[:, -1]
        return np.repeat(ends, self.degree + 1)

    def _room(self, times: np.ndarray) -> Samples:
        """Room for samples, used again and again: fresh memory costs more than filling it."""
        n, size = times.size, self.state.q.size + self.state.u.size
        if len(self._held) < n:
            self._held, self._lengths = np.zeros((n, size)), np.zeros((2, n))
        self._lengths[0, :n], self._lengths[1, :n] = 0.0, 1.0
        return Samples(times, self._held[:n], self._lengths[0, :n], self._lengths[1, :n])

    def states(self, samples: Samples) -> np.ndarray:
        """States (n, times) at the times of samples."""
        return self._modes.states(self.coordinates(samples))

    def coordinates(self, samples: Samples) -> np.ndarray:
        """What `State.q` is at the times of samples, (times, 2 modes + rotations)."""
        return coordinates(samples, self._modes, self.degree)

    def _fail(self, status: int, t0: float, rungs: Rungs) -> None:
        t = self.reached(t0, rungs.lengths[0])
        why = "the laws have no solution" if status == NOT_CONVERGED else "a state is not finite"
        raise CoreStopped(
            f"the condensed core of {self._system.twin.system.name} stops at {t:g} s, in a step of "
            f"{rungs.lengths[-1]:g} s: {why}",
            t,
        )


def _filled(values: np.ndarray) -> np.ndarray:
    """Values, then zeros; see `Rungs`."""
    found = aligned(padded(values.size))
    found[: values.size] = values
    return found


def _room_of(fixed: Fixed, state: State) -> Work:
    rows, inputs = fixed.offset.size, state.u.size
    return Work(
        aligned(inputs), aligned(inputs), aligned(rows), aligned(rows), np.zeros(inputs, np.int64)
    )


@cache
def _ahead(degree: int, of: int) -> np.ndarray:
    """Values of a step, continued over one of 2^-d of its length, d from -HALVINGS on.

    Along the polynomial of a degree that goes through the end and fits the other nodes best.
    """
    shares = 2.0 ** -np.arange(-HALVINGS, HALVINGS + 1)
    return np.array([continued(degree, of, share).T for share in shares])
