"""A line tells that steps cannot be as long as the tolerance would let them be."""

from types import SimpleNamespace

import numpy as np
import pytest

from herringbone.cosim.algorithms.adaptive.figures import longest_steps
from herringbone.cosim.loops.adaptive_step.ladder import RUNGS, TICKS
from herringbone.cosim.rows.record import Grid

TICK, TOLERANCE = 1e-4 / TICKS, 1e-2


def line_of(longest_taken, error, every, among=480):
    """After steps of the longest rung, and others of `among` ticks."""
    taken = np.zeros(len(RUNGS), dtype=np.int64)
    taken[RUNGS.index(min(every or TICKS, TICKS))] = longest_taken
    taken[RUNGS.index(among)] += 10
    run = SimpleNamespace(
        rungs=np.array(RUNGS), taken=taken, last=int(taken @ RUNGS), far=np.array([error])
    )
    return longest_steps(run, Grid(TICK, run.last, every), TOLERANCE)


@pytest.mark.parametrize(
    ("every", "said"),
    [
        (TICKS, "as long as rows are apart (0.0001 s)"),
        (480, "as long as rows are apart (5e-05 s)"),
        (4 * TICKS, "as long as steps can be (0.0001 s)"),
        (0, "as long as steps can be (0.0001 s)"),
    ],
)
def test_what_keeps_steps_short_is_told(every, said):
    line = line_of(100, 2e-4, every)
    assert said in line
    assert line.endswith("and err 0.0002, where 0.01 is asked for")


def test_nothing_is_told_where_the_tolerance_decides():
    assert not line_of(100, 2e-3, TICKS)  # it errs a fifth of it
    assert not line_of(20, 2e-4, TICKS)  # a fifth of the run was in shorter steps
