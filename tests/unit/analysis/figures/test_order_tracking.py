"""Order tracking on chirps of known orders."""

import tracemalloc

import numpy as np
import pytest

from herringbone.analysis.figures.order_tracking import frequency_map, growing, order_map
from herringbone.core import ParameterError

STEP = 2e-5
TIME = np.arange(100_001) * STEP
CYCLES = 20.0 * TIME + 0.5 * 200.0 * TIME**2
"""From 20 to 420 cycles/s in 2 s."""
ORDERS = {1.0: 2.0, 2.5: 0.7, 4.0: 0.05}


def chirp():
    phases = {order: 2 * np.pi * order * CYCLES + order for order in ORDERS}
    return 3.0 + sum(a * np.sin(phases[order]) for order, a in ORDERS.items())


def test_orders_of_a_chirp_keep_their_amplitude():
    """Cubic splines err by (2 pi f h)^4 / 384 of an amplitude, 1e-5 at 1680 Hz.

    Times by straight lines in c: the angle errs by alpha h^2 / 8 cycles, 1e-8. A straight line
    through 10 cycles of a sine takes 6 / (pi 10)^2 of its power, 0.3 % of its rms.
    """
    found = order_map(TIME, CYCLES, chirp(), 10.0, 6.0)
    for order, amplitude in ORDERS.items():
        assert found.cut(order) == pytest.approx(amplitude, rel=1e-4, abs=2e-5)
    assert np.nanmax(found.cut(3.2)) < 2e-5
    level = np.sqrt(sum(a**2 for a in ORDERS.values()) / 2)
    assert found.level == pytest.approx(level, rel=3.1e-3)


def test_speed_of_a_block_is_that_of_its_cycles():
    """Mean speed of a block of constant acceleration: that at the middle of its duration."""
    found = order_map(TIME, CYCLES, chirp(), 10.0, 6.0)
    assert found.speed == pytest.approx(20.0 + 200.0 * found.time, rel=1e-6)
    assert np.diff(found.speed).min() > 0.0


def test_a_run_up_from_standstill_takes_no_more_samples_than_its_records_call_for():
    """The first records lie 1e-7 of a block apart: 12 million samples of 8 bytes if none may fold.

    Splines err by (2 pi f h)^4 / 384 of an amplitude, 4e-4 at 100 Hz and h = 1 ms; a straight
    line in c by alpha h^2 / 8 cycles, 3e-6.
    """
    time = np.arange(2001) * 1e-3
    cycles = 8.0 * time**2.25
    tracemalloc.start()
    found = order_map(time, cycles, 2.0 * np.sin(2 * np.pi * 2.0 * cycles), 10.0, 4.0)
    largest = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert largest < 20e6
    assert found.cut(2.0) == pytest.approx(2.0, rel=5e-4)
    assert found.cut(3.2) == pytest.approx(0.0, abs=1e-3)


def test_a_fixed_frequency_crosses_the_orders():
    """A 300 Hz tone is order 300 / speed: the largest order of each block is the nearest one."""
    found = order_map(TIME, CYCLES, np.sin(2 * np.pi * 300.0 * TIME), 40.0, 4.0)
    seen = (found.speed > 120.0) & (found.speed < 350.0)
    largest = found.order[np.nanargmax(found.amplitude, axis=1)]
    sweep = 40.0 * 200.0 / found.speed**2  # change of speed in a block, over the speed
    band = 300.0 / found.speed * sweep + 1.0 / 40.0
    assert (np.abs(largest - 300.0 / found.speed) <= band)[seen].all()


def test_nothing_is_said_above_half_the_record_rate():
    rows = slice(None, None, 25)  # 2 kHz: order 6 is known up to 1000 / 6 = 166.7 cycles/s
    found = order_map(TIME[rows], CYCLES[rows], chirp()[rows], 10.0, 6.0)
    known = np.isfinite(found.cut(6.0))
    assert known[found.speed < 166.0].all()
    assert not known[found.speed > 167.5].any()
    assert np.isfinite(found.cut(1.0)).all()


def test_map_has_the_frequency_of_each_time():
    """Order 1 at block middles, within a bin (20 Hz) and the chirp's sweep in a block (10 Hz)."""
    found = frequency_map(TIME, np.gradient(CYCLES, STEP), chirp(), 0.05)
    largest = found.frequency[found.amplitude.argmax(axis=1)]
    assert largest == pytest.approx(20.0 + 200.0 * found.time, abs=30.0)
    assert found.speed == pytest.approx(20.0 + 200.0 * found.time, abs=1e-3)


def test_what_cannot_be_tracked_is_refused():
    with pytest.raises(ParameterError, match="has 440 cycles, too few for blocks of 500"):
        order_map(TIME, CYCLES, chirp(), 500.0, 6.0)
    with pytest.raises(ParameterError, match="turns in one direction"):
        order_map(TIME, -CYCLES, chirp(), 10.0, 6.0)
    with pytest.raises(ParameterError, match=r"order 1\.05: the map has multiples of 0.1 up to 6"):
        order_map(TIME, CYCLES, chirp(), 10.0, 6.0).cut(1.05)
    with pytest.raises(ParameterError, match="at most the 2 s of the run"):
        frequency_map(TIME, CYCLES, chirp(), 3.0)


def test_longest_stretch_that_turns_forward():
    rows = growing(np.array([0.0, 0.0, 0.0, 1.0, 2.0, 1.0, 2.0]))
    assert (rows.start, rows.stop) == (2, 5)
    assert growing(np.zeros(4)) == slice(0, 0)
