"""The course of a fused run: its pieces between breakpoints, its rows, some thousand steps at once.

Everything is cut into the same portions whenever it is run, so that a run that goes on from a
checkpoint has the same bits as one that was never cut off.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.condensed.march import BENDS, EVALUATIONS, HALVINGS, STEPS
from herringbone.analysis.twin.condensed.march_arrays import Samples
from herringbone.analysis.twin.fused.core import Core, Steps
from herringbone.analysis.twin.fused.mark import Mark, as_arrays, from_arrays

_AT_ONCE = 250
"""Base steps of a portion: a millisecond of computing, whose steps are kept in the cache."""
_MOST_ROWS = 2048
_SAME = 1e-9
"""Relative difference of lengths that are one: rounding of times."""


class Piece(NamedTuple):
    """What lies between two breakpoints.

    Attributes:
        begin, end: [s].
        step: base step [s].
        last: row after the last one of the piece.
    """

    begin: float
    end: float
    step: float
    last: int


class Course:
    """A fused run from the start values on, or what follows a mark of one.

    Args:
        core: of the system.
        times: of the rows, equidistant from 0 [s].
        steps: how it is marched.
        columns: recorded outputs.
        watched: times at which marks are left, ascending [s].
        after: begin there, with steps of the same degree; all times are since then.

    Attributes:
        row: rows that are done.
        pieces: of the run.
        marks: that were left.
    """

    def __init__(
        self,
        core: Core,
        times: np.ndarray,
        steps: Steps,
        columns: Sequence[str],
        *,
        watched: Sequence[float] = (),
        after: Mark | None = None,
    ) -> None:
        self._times, self._watched = times, watched
        self._since = after.time if after else 0.0
        self.marks: list[Mark] = []
        self.pieces = _pieces(core, times, steps.length, self._since)
        gap = float(times[1] - times[0]) if times.size > 1 else 0.0
        inside = any(_inside(piece, gap) for piece in self.pieces)
        self._outputs = core.outputs(columns, steps, inside=inside)
        self._run = core.solution(steps)
        if after:
            self._run.put(after.state)
        longest = max((piece.step for piece in self.pieces), default=gap)
        rows = round(_AT_ONCE * longest / gap) if gap else 1
        self._rows = max(1, min(_MOST_ROWS, rows))
        self._piece, self._entered, self.row = 0, False, 0

    @property
    def ended(self) -> bool:
        """True if all rows are done."""
        return self._piece == len(self.pieces)

    @property
    def counts(self) -> dict[str, int]:
        """Steps taken, halvings, evaluations of the laws, places where they bend."""
        found = self._run.state.counted
        names = {"steps": STEPS, "halvings": HALVINGS, "evaluations": EVALUATIONS, "bends": BENDS}
        return {name: int(found[k]) for name, k in names.items()}

    def advance(self) -> tuple[np.ndarray, np.ndarray]:
        """Times (n,) [s] and values (n, columns) of the next rows; there may be none.

        Raises:
            CoreStopped: the laws have no solution in the shortest step, or it diverges.
        """
        piece, since = self.pieces[self._piece], self._since
        begin, end = since + piece.begin, since + piece.end
        if not self._entered:
            self._run.enter(begin, end)
            self._entered = True
        last = min(self.row + self._rows, piece.last)
        mark = self._next_mark(piece, last)
        if mark is not None:
            last = int(np.searchsorted(self._times, mark))
        wanted, whole = self._times[self.row : last], last == piece.last and mark is None
        then = [np.inf] * whole if mark is None else [mark]
        samples = self._run.part(begin, end, piece.step, since + np.append(wanted, then))
        rows = Samples(*(kept[: wanted.size] for kept in samples))
        values = self._outputs.values(self._run, rows)
        self.row = last
        if mark is not None:
            self.marks.append(Mark(self._run.reached(begin, piece.step), self._run.saved()))
        if whole:
            self._piece, self._entered = self._piece + 1, False
        return wanted, values

    def _next_mark(self, piece: Piece, last: int) -> float | None:
        """When the next mark is left [s]; None if rows before the `last` one come first."""
        if len(self.marks) == len(self._watched):
            return None
        mark = self._watched[len(self.marks)]
        is_next = mark < piece.end and np.searchsorted(self._times, mark) <= last
        return mark if is_next else None

    def saved(self) -> dict[str, np.ndarray]:
        """What is needed to go on with the same bits."""
        place = np.array([self._piece, self._entered, self.row])
        core = {f"core.{k}": v for k, v in self._run.saved().items()}
        return {"course": place, **core, **as_arrays(self.marks)}

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """Go on from there."""
        self._piece, self._entered, self.row = (
            int(saved["course"][0]),
            bool(saved["course"][1]),
            int(saved["course"][2]),
        )
        self.marks = from_arrays(saved)
        self._run.put({k.removeprefix("core."): v for k, v in saved.items()})


def _pieces(core: Core, times: np.ndarray, longest: float, since: float) -> list[Piece]:
    end, gap = float(times[-1]), float(times[1] - times[0]) if times.size > 1 else 0.0
    found, t0 = [], 0.0
    inside = [t - since for t in core.twin.breakpoints(since + end) if t > since]
    for t1 in [*inside, end]:
        last = times.size if t1 == end else int(np.searchsorted(times, t1))
        found.append(Piece(t0, t1, base_step(t1 - t0, gap, longest), last))
        t0 = t1
    return found


def base_step(length: float, gap: float, longest: float) -> float:
    """A step that divides the length of a piece, and goes together with the gap of records [s].

    A whole number of steps makes a gap, or of gaps a step, wherever the length allows it.
    """
    if gap > 0.0 and length > 0.0:
        gaps = length / gap
        if abs(gaps - round(gaps)) <= _SAME * gaps:
            whole = round(gaps)
            if longest * (1.0 + _SAME) >= gap:
                most = int(longest * (1.0 + _SAME) / gap)
                return length / (whole / next(m for m in range(most, 0, -1) if whole % m == 0))
            return length / (whole * int(np.ceil(gap / longest * (1.0 - _SAME))))
    return length / max(1.0, np.ceil(length / longest * (1.0 - _SAME)))


def _inside(piece: Piece, gap: float) -> bool:
    """True if records lie inside of steps."""
    if not gap or not piece.step:
        return False
    per, before = gap / piece.step, piece.begin / gap
    return any(abs(x - round(x)) > 1e-6 for x in (per, before))
