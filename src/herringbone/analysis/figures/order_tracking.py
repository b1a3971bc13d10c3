"""Order tracking: amplitudes over multiples of a rotation, of runs whose speed changes.

Cycles c(t) are turns of a shaft times a number per turn: 1 for shaft orders, the teeth for mesh
orders. A signal x is resampled at equal steps of c (computed order tracking):

    t_i = c^-1(c_b + i C / N),  x_i = x(t_i),  i = 0 ... N - 1

in blocks of C cycles; x by cubic splines through the records, t by linear interpolation in the
strictly growing c. N is chosen per block so that a step is never longer than a record's: nothing
folds. A block that begins or ends at standstill would take N without end; there a step is at most
1/64 of the block's mean one: what is slower may fold, at constant acceleration less than a
thousandth of the block's angle, at the end that the window fades out. The Hann-windowed Fourier
transform of a block gives amplitudes at the orders k / C,

    a_k = 2 / sum(w) |sum_i w_i (x_i - mean) exp(-2 pi j k i / N)|

A component A sin(2 pi o c + phi) with o C a whole number shows A, however fast c grows. Orders
whose frequency lies above half the record rate are NaN. The speed of a block is C over the time it
takes.

Source: K. R. Fyfe, E. D. S. Munck, Analysis of computed order tracking, Mechanical Systems and
Signal Processing 11 (1997) 187-205.
"""

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from herringbone.analysis.figures.spectra import FEWEST_SAMPLES, hann_weight, one_sided
from herringbone.core import ParameterError
from herringbone.core.wording import option

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

_FINER = 1.5
"""Samples of a block over its records where they are closest in angle."""
_FINEST = 64
"""Samples of a block over its records at most: of a block that touches standstill."""


class OrderMap(NamedTuple):
    """Amplitudes over blocks and orders.

    Attributes:
        time: (m,) middle of each block [s].
        speed: (m,) mean in each block [cycles/s].
        order: (k,) multiples of the cycle, from 0.
        amplitude: (m, k) in the signal's unit; NaN above half the record rate.
        level: (m,) root mean square of each block less a straight line (load and speed drift in a
            run-up), in the signal's unit.
    """

    time: np.ndarray
    speed: np.ndarray
    order: np.ndarray
    amplitude: np.ndarray
    level: np.ndarray

    def cut(self, order: float) -> np.ndarray:
        """Amplitude (m,) of one order.

        Raises:
            ParameterError: it lies between two orders, or above them.
        """
        k = int(np.abs(self.order - order).argmin())
        if abs(self.order[k] - order) > 1e-6 * max(order, 1.0):
            raise ParameterError(
                f"order {order:g}: the map has multiples of {self.order[1]:g} up to "
                f"{self.order[-1]:g}; take more cycles per block, or a higher order"
            )
        return self.amplitude[:, k]


class FrequencyMap(NamedTuple):
    """Amplitude spectra of blocks of equal duration, for a waterfall.

    Attributes:
        time: (m,) middle of each block [s].
        speed: (m,) mean in each block, in the unit that was given.
        frequency: (k,) [Hz].
        amplitude: (m, k) in the signal's unit.
    """

    time: np.ndarray
    speed: np.ndarray
    frequency: np.ndarray
    amplitude: np.ndarray


def growing(cycles: np.ndarray) -> slice:
    """Rows of the longest stretch in which cycles (n,) grow strictly."""
    up = np.concatenate([[False], np.diff(cycles) > 0.0, [False]])
    ends = np.flatnonzero(np.diff(up.astype(int)))
    starts, stops = ends[::2], ends[1::2]
    if not starts.size:
        return slice(0, 0)
    longest = int((stops - starts).argmax())
    return slice(int(starts[longest]), int(stops[longest]) + 1)


def order_map(
    time: np.ndarray,
    cycles: np.ndarray,
    signal: np.ndarray,
    block: float,
    highest: float,
    overlap: float = 0.75,
) -> OrderMap:
    """Amplitudes of orders over the blocks of a run.

    Args:
        time: (n,) of the records [s].
        cycles: (n,) strictly growing.
        signal: (n,) of any unit.
        block: cycles in a block; orders are multiples of 1 / block.
        highest: order up to which amplitudes are given.
        overlap: share of a block that the next one has too, below 1.

    Raises:
        ParameterError: the cycles do not grow, or the run has no whole block of enough records.
    """
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

    if time.size < FEWEST_SAMPLES or not (np.diff(cycles) > 0.0).all():
        raise ParameterError("orders take a shaft that turns in one direction, and 8 records")
    if not (block > 0.0 and highest > 0.0 and 0.0 <= overlap < 1.0):
        raise ParameterError(
            f"block = {block:g} cycles, highest = {highest:g}, overlap = {overlap:g}: they must be "
            "positive, and the overlap below 1"
        )
    spline = CubicSpline(time, signal)
    count = 1 + math.floor((cycles[-1] - cycles[0] - block) / (block * (1.0 - overlap)) + 1e-9)
    orders = np.arange(math.floor(highest * block + 1e-9) + 1) / block
    rows = []
    for b in range(max(count, 0)):
        begin = cycles[0] + b * block * (1.0 - overlap)
        found = _block(time, cycles, spline, begin, block, orders)
        if found is not None:
            rows.append(found)
    if not rows:
        raise ParameterError(
            f"the run has {cycles[-1] - cycles[0]:.3g} cycles, too few for blocks of {block:g} "
            f"with {FEWEST_SAMPLES} records; take shorter blocks or a shorter "
            f"{option('record_step')}"
        )
    middle, speed, amplitude, level = zip(*rows, strict=True)
    return OrderMap(np.array(middle), np.array(speed), orders, np.array(amplitude), np.array(level))


def _block(
    time: np.ndarray,
    cycles: np.ndarray,
    spline: "CubicSpline",
    begin: float,
    block: float,
    orders: np.ndarray,
) -> tuple[float, float, np.ndarray, float] | None:
    """Middle, speed, amplitudes and level of one block; None of one with too few records."""
    first, last = np.searchsorted(cycles, [begin, begin + block])
    if last - first < FEWEST_SAMPLES:
        return None
    gaps = np.diff(cycles[max(first - 1, 0) : last + 1])
    finest = _FINEST * max(int(last - first), 2 * orders.size)
    count = max(math.ceil(min(_FINER * block / gaps.min(), finest)), 2 * orders.size)
    at = np.interp(begin + block * np.arange(count + 1) / count, cycles, time)
    values = spline(at[:-1])
    duration = float(at[-1] - at[0])
    weight = hann_weight(count)
    amplitude = 2.0 * np.abs(np.fft.rfft(weight * (values - weight @ values)))[: orders.size]
    amplitude[0] = 0.0
    speed = block / duration
    steps = np.diff(time[max(first - 1, 0) : last + 1])
    amplitude[orders * speed > 0.5 / steps.max()] = np.nan
    return float(0.5 * (at[0] + at[-1])), speed, amplitude, _level(values)


def _level(values: np.ndarray) -> float:
    """Root mean square of values (n,) less their straight line of least squares."""
    place = np.arange(values.size) - 0.5 * (values.size - 1)
    rest = values - values.mean()
    rest -= (place @ rest) / (place @ place) * place
    return float(np.sqrt(np.mean(rest**2)))


def frequency_map(
    time: np.ndarray,
    speed: np.ndarray,
    signal: np.ndarray,
    duration: float,
    overlap: float = 0.75,
) -> FrequencyMap:
    """Amplitude spectra of blocks of equal duration, Hann-windowed, each without its mean.

    Args:
        time: (n,) equidistant [s].
        speed: (n,) of a shaft, in any unit.
        signal: (n,) of any unit.
        duration: of a block [s].
        overlap: share of a block that the next one has too, below 1.

    Raises:
        ParameterError: the run is shorter than a block, or a block has too few records.
    """
    step = float(time[-1] - time[0]) / (time.size - 1)
    length = round(duration / step)
    if length < FEWEST_SAMPLES or length > time.size:
        raise ParameterError(
            f"blocks of {duration:g} s: they take {FEWEST_SAMPLES} records of {step:g} s, and at "
            f"most the {time[-1] - time[0]:g} s of the run"
        )
    starts = np.arange(0, time.size - length + 1, max(1, round(length * (1.0 - overlap))))
    blocks = np.lib.stride_tricks.sliding_window_view(signal, length)[starts]
    weight = hann_weight(length)
    windowed = (blocks - (blocks @ weight)[:, None]) * weight
    amplitude = one_sided(np.fft.rfft(windowed, axis=1).T, length).T
    middles = starts + 0.5 * (length - 1)
    means = np.lib.stride_tricks.sliding_window_view(speed, length)[starts].mean(axis=1)
    frequency = np.arange(amplitude.shape[1]) / (length * step)
    return FrequencyMap(time[0] + middles * step, means, frequency, amplitude)
