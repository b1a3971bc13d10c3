"""Where macro steps are divided: about the places of jumps, and not where a motion is too fast."""

from types import SimpleNamespace

import numpy as np
import pytest

from herringbone.cosim.algorithms.dividing import divided
from herringbone.cosim.algorithms.dividing.divisions import Divisions
from herringbone.cosim.layouts.jumps import Jumps
from herringbone.cosim.layouts.layout import Chunk
from herringbone.cosim.loops.common import DONE
from herringbone.cosim.loops.jumps import JUMPED

FINEST = 2.0**-20


def taken(monkeypatch, jumps_in):
    """Status and divisions of a step, and pieces (begin, end) that were tried and taken.

    Args:
        jumps_in: tells by begin and end of a piece whether it is to be divided.
    """
    tried, done = [], []

    def take(self, piece):
        tried.append((piece.begin, piece.end))
        if self._jumps.output.size and jumps_in(piece.begin, piece.end):
            return JUMPED, -1
        done.append((piece.begin, piece.end))
        return DONE, -1

    monkeypatch.setattr(divided._Dividing, "_take", take)
    pair = np.ones((2, 1))
    jumps = Jumps(
        np.zeros(1, np.int64), np.zeros(1, np.int64), np.ones(4), pair, 0.1 * pair, 0.2 * pair,
        np.ones(1), np.ones(1, np.int64),
    )  # fmt: skip
    run = SimpleNamespace(
        jumps=jumps, divisions=Divisions(), correction=np.eye(1),
        buffers=SimpleNamespace(spacing=np.ones(2), counts=np.zeros(3)),
    )  # fmt: skip
    status, steps, _ = divided.divide(run, Chunk(0.0, 1e-4, 5, 1, np.zeros((1, 0)), 1))
    assert steps == 6
    return status, run, tried, done


@pytest.mark.parametrize("places", [(0.3,), (0.3, 0.8), (0.3, 0.3001)])
def test_places_of_jumps_are_found(monkeypatch, places):
    def jumps_in(begin, end):
        return end - begin > FINEST and any(begin <= place < end for place in places)

    status, run, tried, done = taken(monkeypatch, jumps_in)
    assert status == DONE
    assert (run.divisions.steps, run.divisions.unresolved) == (1, 0)
    assert len(tried) <= 2 * 20 * len(places)
    for place in places:
        assert min(end - begin for begin, end in done if begin <= place < end) == FINEST


def test_a_motion_that_the_step_does_not_resolve_is_no_jump(monkeypatch):
    """Jumps in every piece longer than 1/32 of the step: what resolves it takes 62 trials."""
    status, run, tried, done = taken(monkeypatch, lambda begin, end: end - begin > 1.0 / 32.0)
    assert status == divided.SMOOTH
    assert (run.divisions.steps, run.divisions.unresolved) == (0, 1)
    assert len(tried) <= 15
    assert done[-1][1] == 1.0
    assert [begin for begin, _ in done[1:]] == [end for _, end in done[:-1]]  # without gaps
    assert np.all(run.jumps.limit >= divided.SUDDEN * 1.0)  # usual now
