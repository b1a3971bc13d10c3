"""Macro steps in which outputs of foreign parts jump or bend, divided about the place.

A polynomial through nodes on both sides of a jump J is wrong by about J, its impulse by J h, by
chance of the place: the coupling is of first order there. So such a step is taken back and halved.
A half whose differences (see `loops.jumps`) have fallen as those of a smooth output is taken, the
other one is halved again, until what the jump changes in it is nothing over the macro step. What
follows has steps that get longer again, by which the prediction starts anew.

A jump is at one place, in one of two halves. Where halves of a size are halved again at more than
two places it is a motion that the step does not resolve: the rest of the step is taken whole, and
differences of that size are usual from then on.

An event whose time a part tells by early return is found in the same way: the part handles it
inside of the step, and its outputs show it.
"""

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from herringbone.cosim.algorithms.jacobian import PREDICTION, CouplingError, correction_matrix
from herringbone.cosim.layouts.jumps import without
from herringbone.cosim.layouts.layout import Chunk
from herringbone.cosim.layouts.nodes import Control
from herringbone.cosim.loops.common import COUPLING_FAILED, DISCARDED, DONE, PART_FAILED
from herringbone.cosim.loops.jumps import FLOOR, JUMPED, SUDDEN, step_back
from herringbone.cosim.loops.nodes import run_iterated

if TYPE_CHECKING:
    from herringbone.cosim.algorithms.iterated import PreparedNodes

_SMOOTH = np.array([[6.0], [3.0]])
"""By what differences of order 3 and 2 fall at least in half a step; 8 and 4 in the limit."""
_NOTHING = 1e-6
"""Difference times the share of the macro step, over the largest value, that is not divided."""
_CORRECTIONS = 20
"""At the most: the Jacobian is that of a step up to eight times as long, or of before the event."""
_REST = 1e-8
"""Residual that corrections of pieces may leave: what they leave at an event is not made up for by
shorter macro steps, so that no other run tells it."""
_PLACES = 2
"""Pieces of one length that are halved: at most so many jumps are looked for in a step."""
_OCTAVES, _SHORT = 3, 8
"""A Jacobian serves steps down to 2^-3 of its own, and one of 2^-8 of a macro step all shorter."""
_FIRST, _ONE_IN = 16, 4
"""Steps that are divided whatever happens; one in so many more."""
SMOOTH = 100
"""Status, beside those of the loops."""
_LONG_AGO = 1e9
"""Macro steps since values that tell nothing."""
_NEVER = 2**62


@dataclass
class _Piece:
    """Part of a macro step, from `begin` to `end` of it; `before`: differences of what it is of."""

    begin: float
    end: float
    before: np.ndarray = field(repr=False)

    @property
    def share(self) -> float:
        return self.end - self.begin

    @property
    def octave(self) -> int:
        """By how many halvings it is shorter than the macro step."""
        return round(-np.log2(self.share))

    def halves(self, found: np.ndarray) -> "tuple[_Piece, _Piece]":
        middle = 0.5 * (self.begin + self.end)
        return _Piece(middle, self.end, found), _Piece(self.begin, middle, found)


def divide(prepared: "PreparedNodes", chunk: Chunk) -> tuple[int, int, int]:
    """Take a macro step in pieces; status, macro steps done, and who failed, as `run_iterated`.

    The status is SMOOTH after a step without jumps, whose Jacobian is as good as before.

    Args:
        prepared: the run, at the start of a step that has just been taken back.
        chunk: of this step alone.
    """
    n, divisions = chunk.start, prepared.divisions
    if divisions.steps >= _FIRST + n // _ONE_IN:
        return _whole(prepared, chunk, 0.0)
    dividing = _Dividing(prepared, chunk)
    found = dividing.run()
    if dividing.resolved:
        divisions.steps += 1
    else:
        divisions.unresolved += 1
    return found


def _whole(prepared: "PreparedNodes", chunk: Chunk, begin: float) -> tuple[int, int, int]:
    """The rest of a macro step from there on, as it is."""
    divisions = prepared.divisions
    if not divisions.left:
        divisions.since = chunk.t0 + (chunk.start + begin) * chunk.h
    divisions.left += 1
    found = _Dividing(prepared, chunk, looks=False)
    return found.rest(begin)


class _Dividing:
    """One macro step in pieces.

    Attributes:
        resolved: False if it has no jump, but a motion that it does not resolve.
    """

    def __init__(self, prepared: "PreparedNodes", chunk: Chunk, *, looks: bool = True) -> None:
        self._run, self._chunk, self.resolved = prepared, chunk, True
        self._jumps = prepared.jumps if looks else without(prepared.jumps)
        self._lengths = [_LONG_AGO, _LONG_AGO] if chunk.start == 0 else [1.0, 1.0]
        self._measured: int | None = None
        self._correction = np.empty((0, 0))

    def run(self) -> tuple[int, int, int]:
        """See `divide`."""
        run, jumps = self._run, self._jumps
        first = jumps.found.copy()
        pieces = list(_Piece(0.0, 1.0, first).halves(first))
        jumps.learns[0] = 0
        event, places = False, Counter[int]()
        while pieces:
            piece = pieces.pop()
            self._limit(piece)
            status, culprit = self._take(piece)
            if status == JUMPED:
                places[piece.octave] += 1
                if places[piece.octave] > _PLACES:
                    return self._unresolved(first, piece.begin)
                pieces += piece.halves(jumps.found.copy())
                continue
            if status == PART_FAILED and run.buffers.counts[2] == DISCARDED:
                return self._refused(piece.begin)
            if status != DONE:
                return status, self._chunk.start, culprit
            if (jumps.found > np.maximum(piece.before / _SMOOTH, FLOOR * self._largest)).any():
                self._start_anew()
                event = True
        self._learn(first, piece.share, event=event)
        return DONE, self._chunk.start + 1, -1

    def rest(self, begin: float) -> tuple[int, int, int]:
        """What is left of the step, in one piece."""
        status, culprit = self._take(_Piece(begin, 1.0, self._run.jumps.found))
        self._run.jumps.learns[0] = 1
        return status, self._chunk.start + (status == DONE), culprit

    @property
    def _largest(self) -> np.ndarray:
        return self._jumps.largest[self._jumps.group]

    def _limit(self, piece: _Piece) -> None:
        """Differences above which a piece is divided."""
        nothing = _NOTHING / piece.share * self._largest
        self._jumps.limit[:] = np.maximum(piece.before / _SMOOTH, nothing)

    def _take(self, piece: _Piece) -> tuple[int, int]:
        """Try a piece: status, and who failed."""
        run, chunk, buffers = self._run, self._chunk, self._run.buffers
        n, h = chunk.start, piece.share * chunk.h
        t = chunk.t0 + (n + piece.begin) * chunk.h
        buffers.spacing[:] = np.array(self._lengths) / piece.share
        try:
            self._correct(piece, t, h)
        except CouplingError as error:
            run.problem = str(error)
            return COUPLING_FAILED, -1
        control = Control(run.corrections, _CORRECTIONS, _REST, np.inf, PREDICTION)
        every = chunk.every if piece.end == 1.0 else _NEVER
        status, _, culprit = run_iterated(
            run.layout, run.nodes, buffers, self._correction, control, self._jumps,
            chunk._replace(t0=t - n * h, h=h, every=every),
        )  # fmt: skip
        if status == DONE:
            run.divisions.pieces += 1
            self._lengths = [piece.share, self._lengths[0]]
            buffers.spacing[:] = self._lengths
            run.look_again()
        return status, culprit

    def _correct(self, piece: _Piece, t: float, h: float) -> None:
        """The correction for a piece."""
        octave = min(piece.octave, _SHORT)
        known = self._measured is not None and 0 <= octave - self._measured < _OCTAVES
        if not known:
            found = self._run.measured(t, h, self._chunk.start + 1)
            self._correction, self._measured = correction_matrix(found, t, h), octave

    def _start_anew(self) -> None:
        """After an event: nothing before it tells what follows."""
        self._lengths = [_LONG_AGO, _LONG_AGO]
        self._run.buffers.spacing[:] = _LONG_AGO
        if self._measured is not None and self._measured < _SHORT:
            self._measured = None

    def _learn(self, first: np.ndarray, share: float, *, event: bool) -> None:
        """What is usual now: that of the last piece, or of a step that was smooth after all."""
        jumps = self._jumps
        powers = np.array([[jumps.weights.size - 1.0], [2.0]])
        last = jumps.found / share**powers
        found = np.minimum(first, last) if event else first
        jumps.usual[:] = np.maximum(jumps.usual, found)
        jumps.learns[0], jumps.limit[:] = 1, SUDDEN * jumps.usual

    def _unresolved(self, first: np.ndarray, begin: float) -> tuple[int, int, int]:
        """The rest of a step that does not resolve a motion."""
        self.resolved = False
        self._learn(first, 1.0, event=False)
        self._jumps = without(self._jumps)
        self._correction, self._measured = self._run.correction, 0
        status, done, culprit = self.rest(begin)
        return (SMOOTH if status == DONE else status), done, culprit

    def _refused(self, begin: float) -> tuple[int, int, int]:
        """A part discards so short a step: this and all others are taken as they are."""
        run = self._run
        culprit = step_back(run.layout, run.nodes, run.buffers)
        run.jumps = without(run.jumps)
        if culprit >= 0:
            return PART_FAILED, self._chunk.start, culprit
        return _whole(run, self._chunk, begin)
