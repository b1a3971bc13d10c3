"""Deviations of single teeth, and what is refused.

Columns: side (left, right), flank (drive, coast), gear (pinion, wheel), tooth (1 to z), position
[m], profile [m], helix [m]: material beyond the ideal flank, normal to it. Profile grows over the
path of contact from -1/2 of the number at the root of the gear's teeth to +1/2 at their tip, helix
over the face coordinate from -1/2 at 0 to +1/2 at the face width. A flank of a side of which
nothing stands there, and a file of zeros, are of ideal teeth.

Teeth are counted in the order in which they come into contact when the phase of their flank grows;
tooth 1 of the pinion and tooth 1 of the wheel enter at its phase 0.
"""

import math

import numpy as np

from herringbone.components.resources.loader import Refusal
from herringbone.core import Column
from herringbone.core.declaring.roles import GEARS, SIDES
from herringbone.kernels.compiling.jit import kernel

COLUMNS = (
    Column("side", words=SIDES),
    Column("flank", words=("drive", "coast")),
    Column("gear", words=GEARS),
    Column("tooth", ("1",)),
    Column("position", ("m",)),
    Column("profile", ("m",)),
    Column("helix", ("m",)),
)
TEETH = 400
"""Most teeth of a gear."""
NUMBERS = 3
_WIDTH = len(COLUMNS)
_GEAR = 1 + NUMBERS * TEETH
TABLE_SIZE = 1 + 4 * 2 * _GEAR
"""Length of the table part: 1 if a number is not zero; by side, flank and gear: teeth; numbers."""
_NO_TOOTH, _TWICE, _GAP = 1, 2, 3
OTHER_COUNT = 4
REFUSALS = (
    Refusal(f": tooth %g must be a whole number from 1 to {TEETH}"),
    Refusal(": tooth %g of a flank of a gear stands twice"),
    Refusal(": tooth %g of a flank of a gear, of which %g teeth stand there: they are counted from "
            "1, none is left out"),
    Refusal(": a flank has deviations of %g teeth of the pinion and %g of the wheel; the pair has "
            "%g and %g"),
)  # fmt: skip


@kernel
def group(at: int, side: int, flank: int, gear: int) -> int:
    """Where the number of teeth of a gear's flank stands; the numbers of its teeth follow."""
    return at + 1 + (4 * side + 2 * flank + gear) * _GEAR


@kernel
def given(b: np.ndarray, at: int, side: int, flank: int) -> bool:
    """True if a flank of a side has deviations."""
    return b[group(at, side, flank, 0)] + b[group(at, side, flank, 1)] > 0.0


@kernel
def collect(values: np.ndarray, rows: int, b: np.ndarray, at: int, report: np.ndarray) -> int:
    """Write the table part at `b[at:]`, which is zero.

    Args:
        values, rows: see `read_numbers`.
        b, at: block and start of the table part (TABLE_SIZE long).
        report: numbers of a refusal.

    Returns:
        0 or the number of a refusal: no number of a tooth, tooth twice, teeth left out.
    """
    for row in range(rows):
        v = _WIDTH * (row + 1)
        for k in range(NUMBERS):
            if values[v + 4 + k] != 0.0:
                b[at] = 1.0
    if b[at] == 0.0:
        return 0
    for row in range(rows):
        v = _WIDTH * (row + 1)
        tooth = report[0] = values[v + 3]
        if not (1.0 <= tooth <= TEETH and tooth == math.floor(tooth)):
            return _NO_TOOTH
        first = group(at, int(values[v]), int(values[v + 1]), int(values[v + 2]))
        b[first] += 1.0
        own = first + 1 + NUMBERS * (int(tooth) - 1)
        for k in range(NUMBERS):
            b[own + k] = values[v + 4 + k]
        for other in range(row):
            u = _WIDTH * (other + 1)
            same = True
            for k in range(4):
                same = same and values[u + k] == values[v + k]
            if same:
                return _TWICE
    for row in range(rows):
        v = _WIDTH * (row + 1)
        report[0] = values[v + 3]
        report[1] = b[group(at, int(values[v]), int(values[v + 1]), int(values[v + 2]))]
        if report[0] > report[1]:
            return _GAP
    return 0


@kernel
def check(b: np.ndarray, at: int, pinion: float, wheel: float, report: np.ndarray) -> int:
    """0, or the number of a refusal: a flank with deviations of another number of teeth."""
    for side in range(2):
        for flank in range(2):
            if given(b, at, side, flank):
                report[0], report[1] = b[group(at, side, flank, 0)], b[group(at, side, flank, 1)]
                report[2], report[3] = pinion, wheel
                if report[0] != pinion or report[1] != wheel:
                    return OTHER_COUNT
    return 0


@kernel
def tooth(b: np.ndarray, first: int, number: float) -> int:
    """Where the numbers of a tooth stand: the one of its gear that meshes as the number-th.

    Args:
        b, first: block and start of the gear's flank, see `group`.
        number: from 0; any whole number.
    """
    turn = number / b[first]
    index = int(number - b[first] * math.floor(turn))
    # The quotient is rounded; a diverging run must not read outside the table.
    return first + 1 + NUMBERS * min(max(index, 0), int(b[first]) - 1)


def largest(b: np.ndarray, at: int) -> float:
    """Bound of the material [m] that two teeth have in each other's way."""
    table = b[at + 1 : at + TABLE_SIZE].reshape(-1, 2, _GEAR)[:, :, 1:]
    bounds = np.abs(table).reshape(-1, 2, TEETH, NUMBERS) @ np.array([1.0, 0.5, 0.5])
    return float(bounds.max(axis=2).sum(axis=1).max())
