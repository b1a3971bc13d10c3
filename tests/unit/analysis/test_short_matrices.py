"""Matrices in single precision, of fused runs at tolerances of 1e-3 and more."""

import numpy as np
import pytest

from herringbone.analysis.accuracy.apart import differences
from herringbone.analysis.twin.condensed import solution
from herringbone.analysis.twin.fused.core import Core, Steps, closeness
from herringbone.analysis.twin.fused.measured import values_at
from herringbone.running.prepared import Wishes, prepared

STEPS = Steps(1e-4, 4, closeness(1e-3))
LENGTH, TIMES = 1e-4, np.arange(101) * 1e-4
HALF = 2.0**-24
"""Relative error of rounding to single precision."""


@pytest.fixture(scope="module")
def core():
    return Core(prepared("test_rig", "loaded", Wishes()).system)


@pytest.fixture
def in_double(monkeypatch):
    """Solutions take double precision from here on when it is called."""
    shape = solution.Shape
    return lambda: monkeypatch.setattr(solution, "Shape", lambda *own: shape(*own[:-1], False))


def made(core):
    """A march at its start, and its matrices of a step."""
    run = core.solution(STEPS)
    run.enter(0.0, 1.0)
    rungs = run.matrices.of(LENGTH)
    run.matrices.make(rungs, 0)
    return run, rungs


def test_they_change_a_run_by_a_hundredth_of_the_tolerance_at_most(core, in_double):
    """Means of forces are a hundred times what alternates, and keep their digits: see `refer`."""
    columns = [name for names in core.groups().values() for name in names]
    short = values_at(core, TIMES, STEPS, columns)
    in_double()
    double = values_at(core, TIMES, STEPS, columns)
    off = differences(short, double, columns, core.groups())
    assert 0.0 < off.worst_difference < 1e-5


def test_angles_that_grow_keep_their_digits(core, in_double):
    """Growth in two columns errs by the square of the rounding; rows over angles by nothing."""
    _, short = made(core)
    in_double()
    _, double = made(core)
    angles, modal = short.rows.shape[1], short.short_rows.shape[1]
    assert angles == 1
    assert short.rows[0].tolist() == double.rows[0, modal:].tolist()
    growth = double.rows[0, :modal, -1]
    found = short.short_rows[0, :, -2:].astype(float)
    assert abs(found[:, 1] - growth).max() > 0.1 * HALF * abs(growth).max()
    assert abs(found.sum(axis=1) - growth).max() < 2.0 * HALF**2 * abs(growth).max()


def test_values_that_stay_push_as_in_double_precision(core):
    """Of what a start errs by, single precision keeps all but its own rounding."""
    run, rungs = made(core)
    ends = run.state.u.reshape(-1, STEPS.degree + 1)[:, -1].copy()
    ends[run._calls.value[-1] : -1], ends[-1] = core.condensed.signals(0.0), 1.0
    first = slice(None, None, STEPS.degree + 1)
    exact = ends @ rungs.push[0, first]
    short = ends @ rungs.short_push[0, first].astype(float)
    corrected = short + rungs.still[0]
    size = abs(ends) @ abs(rungs.push[0, first])
    assert (abs(short - exact) / np.maximum(size, 1e-300)).max() > 0.1 * HALF
    assert abs(corrected - exact) == pytest.approx(0.0, abs=4.0 * HALF**2 * size.max())
