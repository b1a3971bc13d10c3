"""The ladder of macro steps, in ticks."""

import numpy as np
import pytest

from herringbone.cosim.loops.adaptive_step.ladder import RUNGS, TICKS, fitting_rung

LADDER = np.array(RUNGS, dtype=np.int64)


def test_rungs_are_close_and_no_closer():
    """A third at the most, so that little is lost; a fifth at the least, so that few are kept."""
    ratio = LADDER[1:] / LADDER[:-1]
    assert ratio.min() >= 1.2 and ratio.max() <= 4 / 3
    assert [rung for rung in RUNGS if TICKS % rung] == [400, 576, 720]


def test_the_wanted_rung_is_taken_far_from_the_end():
    for wanted in range(LADDER.size):
        assert fitting_rung(LADDER, wanted, 10 * TICKS) == wanted


@pytest.mark.parametrize("wanted", range(len(RUNGS)))
def test_the_end_is_hit_from_everywhere(wanted):
    """From any whole number of largest steps, and from what a step leaves; no step is too long."""
    for start in (TICKS, 3 * TICKS, *range(8, 2000)):
        left = start
        while left > 0:
            rung = fitting_rung(LADDER, wanted, left)
            # Upwards only where a smaller step would leave 1, 2, 3 or 7 ticks.
            assert rung <= wanted or left - RUNGS[wanted] in (1, 2, 3, 7), start
            left -= RUNGS[rung]
        assert left == 0, start
