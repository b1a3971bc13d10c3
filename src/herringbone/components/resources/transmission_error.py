"""A given transmission error: harmonics of the shafts, and what is refused.

Columns: side (left, right), flank (drive, coast), gear (pinion, wheel): whose angle moves it, order
(periods per revolution of that gear, a whole number; mesh frequency: its number of teeth),
amplitude [m], normal to the flank, phase [rad]. Amplitudes of zero are left out.
"""

import math

import numpy as np

from herringbone.components.resources.loader import Refusal
from herringbone.core import Column
from herringbone.core.declaring.roles import GEARS, SIDES
from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.elementary import sine_and_cosine

COLUMNS = (
    Column("side", words=SIDES),
    Column("flank", words=("drive", "coast")),
    Column("gear", words=GEARS),
    Column("order", ("1",)),
    Column("amplitude", ("m",)),
    Column("phase", ("rad",)),
)
HARMONICS = 64
"""Room for those of one flank of one side."""
_WIDTH, _ROW = len(COLUMNS), 4
_GROUP = 1 + _ROW * HARMONICS
TABLE_SIZE = 1 + 4 * _GROUP
"""Length of the table part: number of all; by side and flank, number; gear, order, amplitude,
phase."""
_TOO_MANY, _NOT_WHOLE = 1, 2
REFUSALS = (
    Refusal(f": more than {HARMONICS} harmonics of one flank of one side", 1),
    Refusal(": order %g must be a whole number, zero or more", 1),
)
_TWO_PI = 2.0 * math.pi


@kernel
def group(at: int, side: int, flank: int) -> int:
    """Start of the harmonics of a side's flank; their number stands there."""
    return at + 1 + (2 * side + flank) * _GROUP


@kernel
def collect(values: np.ndarray, rows: int, b: np.ndarray, at: int, report: np.ndarray) -> int:
    """Write the table part at `b[at:]`, which is zero.

    Args:
        values, rows: see `read_numbers`.
        b, at: block and start of the table part (TABLE_SIZE long).
        report: numbers of a refusal.

    Returns:
        0 or the number of a refusal: too many harmonics, order not whole.
    """
    for row in range(rows):
        v = _WIDTH * (row + 1)
        order = values[v + 3]
        if not (order >= 0.0 and order == math.floor(order)):
            report[0] = order
            return _NOT_WHOLE
        if values[v + 4] == 0.0:
            continue
        first = group(at, int(values[v]), int(values[v + 1]))
        count = int(b[first])
        if count == HARMONICS:
            return _TOO_MANY
        b[at] += 1.0
        b[first] = count + 1.0
        for k in range(_ROW):
            b[first + 1 + _ROW * count + k] = values[v + 2 + k]
    return 0


@kernel
def error(b: np.ndarray, at: int, pinion: float, wheel: float) -> tuple[float, float, float]:
    """e [m] of a side's flank, and its slopes over the angles of its pinion and wheel half [m/rad].

    Args:
        b, at: block and start of the harmonics, see `group`.
        pinion, wheel: angles of the half-bodies [rad].
    """
    value, per_pinion, per_wheel = 0.0, 0.0, 0.0
    for k in range(int(b[at])):
        row = at + 1 + _ROW * k
        angle = pinion if b[row] == 0.0 else wheel
        turn = angle / _TWO_PI  # reduced before it is multiplied: high orders lose no digits
        s, c = sine_and_cosine(b[row + 1] * _TWO_PI * (turn - math.floor(turn)) + b[row + 3])
        value += b[row + 2] * c
        slope = -b[row + 1] * b[row + 2] * s
        if b[row] == 0.0:
            per_pinion += slope
        else:
            per_wheel += slope
    return value, per_pinion, per_wheel


def harmonics(b: np.ndarray, at: int, side: int, flank: int) -> np.ndarray:
    """Gear, order, amplitude [m] and phase [rad] of a side's flank, (n, 4); see `error`."""
    first = group(at, side, flank)
    return b[first + 1 : first + 1 + _ROW * int(b[first])].reshape(-1, _ROW)


def largest(b: np.ndarray, at: int) -> float:
    """Bound of e [m] on all flanks: the largest sum of amplitudes."""
    sums = []
    for first in range(at + 1, at + TABLE_SIZE, _GROUP):
        rows = b[first + 1 : first + 1 + _ROW * int(b[first])].reshape(-1, _ROW)
        sums.append(float(np.abs(rows[:, 2]).sum()))
    return max(sums)
