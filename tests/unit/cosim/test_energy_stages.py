"""The energy monitor takes the bodies' forces as the loop gave them: the same polynomial."""

import numpy as np
import pytest

from herringbone.cosim.energy.monitor import PairPlaces, energy_monitor
from herringbone.cosim.energy.stages import _write_forces, _write_slips
from herringbone.cosim.loops.common import signal

ONE, NONE = np.array([0], dtype=np.int64), np.array([-1], dtype=np.int64)
VELOCITY, POSITION = np.array([1], dtype=np.int64), np.array([2], dtype=np.int64)
HISTORY = np.random.default_rng(3).normal(size=(4, 3))
ROUNDING = 1e-14


def monitor(held=0):
    """One pair: force 0, velocity 1, position 2."""
    pair = PairPlaces(
        ONE, POSITION, VELOCITY, ONE, POSITION, VELOCITY, ONE, np.array([held]), ONE + 1, NONE
    )
    matrix = np.ones((1, 1))
    return energy_monitor(pair, True, matrix, matrix, window=1.0, step=1e-3, degree=1)


@pytest.mark.parametrize("known", [1, 2, 3, 9])
@pytest.mark.parametrize("fresh", [0, 1])
@pytest.mark.parametrize("order", [1, 2])
def test_force_is_the_signal(order, fresh, known):
    found = monitor()
    _write_forces(np.array([fresh, 0, 0]), found, HISTORY, order, known)
    for c in (0.0, 0.3, 1.0):
        wanted = signal(HISTORY, 0, fresh, order, known, c)
        assert np.polyval(found.taken[::-1, 0], c) == pytest.approx(wanted, abs=ROUNDING)


@pytest.mark.parametrize("fresh", [0, 1])
def test_a_held_force_is_the_newest_value(fresh):
    found = monitor(held=1)
    _write_forces(np.array([fresh, 0, 0]), found, HISTORY, 2, 9)
    assert found.taken[:, 0].tolist() == [HISTORY[1 - fresh, 0], 0.0, 0.0]


@pytest.mark.parametrize("at_end", [0, 1])
@pytest.mark.parametrize("fresh", [0, 1])
def test_slip_is_what_the_element_saw_less_what_came(fresh, at_end):
    found = monitor()
    _write_slips(np.array([0, fresh, fresh]), np.array([at_end]), found, HISTORY, 1, 9)
    seen = [
        signal(HISTORY, source, fresh, 1, 9, 1.0 if at_end or fresh else 0.0) for source in (2, 1)
    ]
    assert found.slip[:, 0] == pytest.approx(seen - HISTORY[0, [2, 1]], abs=ROUNDING)
    if fresh:
        assert not found.slip.any()
