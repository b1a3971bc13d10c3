"""File of the force law of one pair of teeth, and what is refused.

Columns: position q [1], tilt s [1], then the numbers of the nodes u, in their order, under names of
your choice: M = U / rho^2 [N/m]; their unit is given as that of `stiffness`. q are whole multiples
of 1 / n, n a whole number, without a gap; every q has all s. At the two first and the two last q,
and where |s| > 2.7, M counts as zero. The comment line

    # pair_law: z1 z2 r_b1 r_b2 beta_b b n g D

tells of which pair the law is (as of the stiffness table: teeth, base radii [m], base helix angle
[rad], face width [m]), n, the length g of the path of contact [m] and the depth D [m]. With p_bt =
2 pi r_b1 / z1, eps_a = g / p_bt and eps_b = b tan|beta_b| / p_bt. A file without that line has no
law.

The law of a side is brought in line with the side's stiffness table: at the nodes of position q, M
is multiplied by U(q, rho) of the table over the sum of rho^2 M(q + j, s = 0, u) over all whole
numbers j. Here u = 0 is rho = D / 10^4; the factor of u = 7/8 holds for u = 1, too; where that sum
is zero it is 1.
"""

import math

import numpy as np

from herringbone.components.resources.loader import Refusal
from herringbone.core import Column
from herringbone.kernels import force_law, tooth_pair_law
from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.elementary import cosine, sine

POSITIONS, TILTS = tooth_pair_law.POSITIONS, tooth_pair_law.TILTS
DEPTHS = tooth_pair_law.DEPTHS
"""Nodes: at most over q, over s, over u."""
HEADER = ("pair_law", 9)
COLUMNS = (
    Column("position", ("1",)),
    Column("tilt", ("1",)),
    Column("stiffness", ("N/m",), rest=True),
)
_NUMBERS_AT = len(COLUMNS)
PER_PERIOD, LENGTH, UNIT = (_NUMBERS_AT + k for k in (6, 7, 8))
"""Where n, g and D stand in the numbers of a file; the pair stands before them."""
PAIR_AT = _NUMBERS_AT
_FIRST = _NUMBERS_AT + HEADER[1]
_WIDTH = 2 + DEPTHS
_SLIGHT, _SMALLEST = 1e-6, 1e-4
_NO_NODES, _NO_HEAD, _NO_PLACE, _TOO_MANY, _NEGATIVE = range(1, 6)
REFUSALS = (
    Refusal(f" has %g rows with %g values of the stiffness; give {DEPTHS} in each of the {TILTS} "
            "rows of every position"),
    Refusal(": n %g must be a whole number from 4, g %g m and D %g m positive"),
    Refusal(": row %g has position %.9g and tilt %.9g where %.9g and %.9g must stand"),
    Refusal(f": %g positions; at least 8 and at most {POSITIONS}"),
    Refusal(": stiffness %g N/m at position %g, tilt %g must not be negative"),
)  # fmt: skip


def tilts() -> np.ndarray:
    """(TILTS,) nodes s."""
    return np.linspace(-tooth_pair_law.STEEPEST, tooth_pair_law.STEEPEST, TILTS)


def depths(unit: float) -> np.ndarray:
    """(DEPTHS,) rho [m] at the nodes u, the last infinite; unit: D [m]."""
    u = np.arange(DEPTHS - 1) / (DEPTHS - 1.0)
    return np.append(unit * u * u / (1.0 - u * u), np.inf)


def line_ends(position: float, transverse: float, overlap: float) -> tuple[float, float]:
    """m and h of the line at a position, by the contact ratios."""
    return tooth_pair_law.ends(position, transverse, overlap)


@kernel
def is_law(values: np.ndarray) -> bool:
    """True if a file has a law; numbers as of `read_numbers`."""
    return values[_NUMBERS_AT] == values[_NUMBERS_AT]


@kernel
def check(values: np.ndarray, rows: int, width: int, report: np.ndarray) -> int:
    """0, or the number of a refusal.

    Args:
        values, rows, width: see `read_numbers`.
        report: numbers of a refusal.
    """
    report[0], report[1] = rows, width - 2
    if width != _WIDTH or rows % TILTS != 0:
        return _NO_NODES
    count, n = rows // TILTS, values[PER_PERIOD]
    report[0], report[1], report[2] = n, values[LENGTH], values[UNIT]
    if not (n >= 4.0 and n == math.floor(n) and values[LENGTH] > 0.0 and values[UNIT] > 0.0):
        return _NO_HEAD
    report[0] = count
    if not 8 <= count <= POSITIONS:
        return _TOO_MANY
    first = math.floor(values[_FIRST] * n + 0.5)
    for row in range(rows):
        at = _FIRST + _WIDTH * row
        position, tilt = values[at], values[at + 1]
        q = (first + row // TILTS) / n
        s = tooth_pair_law.STEEPEST * (2.0 * (row % TILTS) / (TILTS - 1) - 1.0)
        report[0], report[1], report[2], report[3], report[4] = row + 1, position, tilt, q, s
        if not (abs(position - q) <= _SLIGHT and abs(tilt - s) <= _SLIGHT):
            return _NO_PLACE
        for k in range(DEPTHS):
            report[0], report[1], report[2] = values[at + 2 + k], position, tilt
            if not values[at + 2 + k] >= 0.0:
                return _NEGATIVE
    return 0


@kernel
def contact_ratios(values: np.ndarray) -> tuple[float, float]:
    """Transverse contact ratio and overlap ratio of the pair that a law is of, of either hand."""
    teeth, base = values[PAIR_AT], values[PAIR_AT + 2]
    angle, width = abs(values[PAIR_AT + 4]), values[PAIR_AT + 5]
    pitch = 2.0 * math.pi * base / teeth
    return values[LENGTH] / pitch, width * sine(angle) / cosine(angle) / pitch


@kernel
def _value(values: np.ndarray, i: int, j: int, k: int) -> float:
    return values[_FIRST + (i * TILTS + j) * _WIDTH + 2 + k]


@kernel
def _factor(
    values: np.ndarray, first: int, count: int, i: int, k: int, b: np.ndarray, table: int
) -> float:
    """Energy of a stiffness table over that of all pairs with ideal teeth, at a node of q and u."""
    n, u = int(values[PER_PERIOD]), k / (DEPTHS - 1.0)
    rho = values[UNIT] * (u * u / (1.0 - u * u) if k > 0 else _SMALLEST)
    total, other = 0.0, i
    while other >= 2 + n:
        other -= n
    while other < count - 2:
        total += _value(values, other, TILTS // 2, k)
        other += n
    if total == 0.0:
        return 1.0
    phase = (first + i) / n
    return force_law.energy(b, table, phase, rho) / (rho * rho * total)


@kernel
def place(
    values: np.ndarray,
    rows: int,
    b: np.ndarray,
    at: int,
    table: int,
    scratch: np.ndarray,
) -> None:
    """Make the table part of a side at `b[at:]`, which is zero, from a file that was checked.

    Args:
        values, rows: see `read_numbers`.
        b, at: block and start of the table part.
        table: start of the side's stiffness table in the block.
        scratch: POSITIONS long.
    """
    n, count = values[PER_PERIOD], rows // TILTS
    first = math.floor(values[_FIRST] * n + 0.5)
    for i in range(2, count - 2):
        for k in range(DEPTHS):
            factor = _factor(values, first, count, i, min(k, DEPTHS - 2), b, table)
            for j in range(2, TILTS - 2):
                node = tooth_pair_law.node(at, i, j, k)
                b[node] = factor * _value(values, i, j, k)
    transverse, overlap = contact_ratios(values)
    tooth_pair_law.build(first, int(n), count, values[UNIT], transverse, overlap, b, at, scratch)
