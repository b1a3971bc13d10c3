"""The stiffness table: secant stiffness of each half over load and phase, and what is refused.

Columns: side (left, right), load [N] (normal force of the own side), phase [mesh periods],
stiffness [N/m] (secant, normal direction). At zero load, which a table may have, the stiffness is
the limit; it is zero there if the unloaded flanks have a gap. `read_stiffness_table` gives a table
as arrays, off line, with the component's own refusals. The comment line

    # pair: z1 z2 r_b1 r_b2 beta_b b

tells of which pair the table is: teeth, base radii [m], base helix angle [rad], face width per half
[m]. It may be left out.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from herringbone.components.resources.flat_csv import read_header
from herringbone.components.resources.loader import REPORT, Refusal, read_numbers
from herringbone.core import Column
from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.force_law import LOADS, PHASES

SIDES = ("left", "right")
STATED_HARMONICS = 4
"""Mesh harmonics of which a table may state the uncertainty, in a line `# uncertainty:`."""
COLUMNS = (
    Column("side", words=SIDES),
    Column("load", ("N",)),
    Column("phase", ("1",)),
    Column("stiffness", ("N/m",)),
)
PAIR = ("pair", 6)
"""The header line of the pair: teeth, base radii [m], base helix angle [rad], face width [m]."""
_WIDTH = len(COLUMNS)
PAIR_AT = _WIDTH
"""Where the pair stands in the numbers of a file."""
_FIRST = PAIR_AT + PAIR[1]
SIZE = _FIRST
"""Length of the numbers of a file without its rows."""
_ROWS = 2 * LOADS * (PHASES + 1)
_PHASES_AT, GRID = _ROWS, 2 * _ROWS
SCRATCH_SIZE = 3 * _ROWS
"""Length of the scratch space of `collect`."""
_PERIODIC, _EQUIDISTANT, _LEAST = 1e-6, 1e-5, 1e-300

(
    _TOO_LONG, _NO_GRID, _NOT_POSITIVE, _NO_LOAD, _NOT_PERIODIC, _NOT_EQUIDISTANT, _TOO_LARGE,
    _NOT_MONOTONE,
) = range(1, 9)  # fmt: skip
_OF_SIDE = (
    "%g rows are no full grid of %g loads x %g phases; give every load at every phase "
    "(at least 2 x 4)",
    "stiffness %g N/m at load %g N, phase %g must be positive",
    "load %g N must not be negative",
    "not periodic: stiffness at phase 1 differs from phase 0 by %.3g %%",
    "phases must be equidistant from 0 to below 1 (one mesh period); they run from %g to %g",
    f"%g loads x %g phases; at most {LOADS} x {PHASES}",
    "deflection does not rise from load %g N to %g N at phase %g; the force law would not be "
    "monotone",
)
REFUSALS = (
    Refusal(f": %g rows; at most {_ROWS}"),
    *(Refusal(f", side {side}: {text}") for side in SIDES for text in _OF_SIDE),
)


@kernel
def _place(s: np.ndarray, at: int, count: int, value: float) -> int:
    """Where `value` stands, or belongs, in the ascending numbers at `s[at:]`."""
    low, high = 0, count
    while low < high:
        middle = (low + high) // 2
        if s[at + middle] < value:
            low = middle + 1
        else:
            high = middle
    return low


@kernel
def _insert(s: np.ndarray, at: int, count: int, value: float) -> int:
    """Insert `value` if it is new; the new count."""
    i = _place(s, at, count, value)
    if i < count and s[at + i] == value:
        return count
    for k in range(count, i, -1):
        s[at + k] = s[at + k - 1]
    s[at + i] = value
    return count + 1


@kernel
def _axes(values: np.ndarray, rows: int, side: int, s: np.ndarray) -> tuple[int, int, int]:
    """Rows of a side; its loads and phases, ascending, in the scratch."""
    own, loads, phases = 0, 0, 0
    for row in range(rows):
        at = _FIRST + _WIDTH * row
        if values[at] == side:
            own += 1
            loads = _insert(s, 0, loads, values[at + 1])
            phases = _insert(s, _PHASES_AT, phases, values[at + 2])
    return own, loads, phases


@kernel
def _fill(values: np.ndarray, rows: int, side: int, s: np.ndarray, loads: int, phases: int) -> bool:
    """Write the stiffness of a side to the grid in the scratch; False if a point stands twice."""
    for i in range(loads * phases):
        s[GRID + i] = np.nan
    for row in range(rows):
        at = _FIRST + _WIDTH * row
        if values[at] == side:
            i = _place(s, 0, loads, values[at + 1])
            j = _place(s, _PHASES_AT, phases, values[at + 2])
            here = GRID + i * phases + j
            if s[here] == s[here]:
                return False
            s[here] = values[at + 3]
    return True


@kernel
def _check_values(
    values: np.ndarray, rows: int, side: int, s: np.ndarray, report: np.ndarray
) -> int:
    for row in range(rows):
        at = _FIRST + _WIDTH * row
        least = 0.0 if values[at + 1] == 0.0 else _LEAST
        if values[at] == side and not values[at + 3] >= least:
            report[0], report[1], report[2] = values[at + 3], values[at + 1], values[at + 2]
            return _NOT_POSITIVE
    report[0] = s[0]
    return _NO_LOAD if s[0] < 0.0 else 0


@kernel
def _one_period(s: np.ndarray, loads: int, phases: int, report: np.ndarray) -> tuple[int, int]:
    """Drop a repeated end point; check that the phases are i / n. Refusal and phases."""
    if abs(s[_PHASES_AT + phases - 1] - 1.0) < 1e-9:
        jump = 0.0
        for i in range(loads):
            row = GRID + i * phases
            if s[row] > 0.0:
                jump = max(jump, abs(s[row + phases - 1] / s[row] - 1.0))
        if jump > _PERIODIC:
            report[0] = 100.0 * jump
            return _NOT_PERIODIC, phases
        phases -= 1
        for i in range(loads):
            for j in range(phases):
                s[GRID + i * phases + j] = s[GRID + i * (phases + 1) + j]
    report[0], report[1] = s[_PHASES_AT], s[_PHASES_AT + phases - 1]
    for j in range(phases):
        if abs(s[_PHASES_AT + j] - j / phases) > _EQUIDISTANT:
            return _NOT_EQUIDISTANT, phases
    return 0, phases


@kernel
def _check_monotone(s: np.ndarray, loads: int, phases: int, report: np.ndarray) -> int:
    for i in range(loads - 1):
        for j in range(phases):
            here = GRID + i * phases + j
            deflection = s[i] / s[here] if s[i] > 0.0 else 0.0
            if s[i + 1] / s[here + phases] <= deflection:
                report[0], report[1], report[2] = s[i], s[i + 1], s[_PHASES_AT + j]
                return _NOT_MONOTONE
    return 0


@kernel
def collect(
    values: np.ndarray, rows: int, side: int, s: np.ndarray, report: np.ndarray
) -> tuple[int, int, int]:
    """Check one side of a table and arrange it.

    Args:
        values, rows: see `read_numbers`.
        side: 0 left, 1 right.
        s: scratch (SCRATCH_SIZE long).
        report: numbers of a refusal.

    Returns:
        0 or the number of a refusal (too long, no full grid, stiffness not positive, load
        negative, not periodic, phases not equidistant from 0, too large, force not rising with
        deflection); numbers of loads and of phases. The loads [N] then stand at `s[0:]`,
        ascending, and the stiffness [N/m] at `s[GRID + load * phases + phase]`, phases i / n.
    """
    if rows > _ROWS:
        report[0] = rows
        return _TOO_LONG, 0, 0
    of_side = side * (_NOT_MONOTONE - _TOO_LONG)
    own, loads, phases = _axes(values, rows, side, s)
    report[0], report[1], report[2] = own, loads, phases
    if loads < 2 or phases < 4 or own != loads * phases:
        return of_side + _NO_GRID, loads, phases
    if not _fill(values, rows, side, s, loads, phases):
        return of_side + _NO_GRID, loads, phases
    refusal = _check_values(values, rows, side, s, report)
    if refusal == 0:
        refusal, phases = _one_period(s, loads, phases, report)
    if refusal == 0 and (loads > LOADS or phases > PHASES):
        report[0], report[1] = loads, phases
        refusal = _TOO_LARGE
    if refusal == 0:
        refusal = _check_monotone(s, loads, phases, report)
    return (of_side + refusal if refusal else 0), loads, phases


def read_stiffness_table(file: Path) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """Read and check a stiffness table.

    Returns:
        For left and right: loads (n,), ascending, and stiffness (n, phases) at phases i / phases.

    Raises:
        ResourceError: see `read_numbers` and `collect`.
    """
    values, (rows, _) = read_numbers(file, COLUMNS, *PAIR)
    tables = []
    for side in range(len(SIDES)):
        s, report = np.empty(SCRATCH_SIZE), np.zeros(REPORT)
        refusal, loads, phases = collect(values, rows, side, s, report)
        if refusal:
            raise REFUSALS[refusal - 1].error([file], report)
        tables.append((s[:loads].copy(), s[GRID : GRID + loads * phases].reshape(loads, phases)))
    return tuple(tables)


class Uncertainty(NamedTuple):
    """What a table states of itself, over its mean stiffness [1].

    Attributes:
        mean: uncertainty of the mean.
        harmonics: (4,) of the amplitudes of mesh harmonics 1 to 4, at most.
        amplitudes: (4,) these amplitudes, at the load asked about.
    """

    mean: float
    harmonics: np.ndarray
    amplitudes: np.ndarray


def read_uncertainty(file: Path, load: float) -> Uncertainty | None:
    """What a table states of its uncertainty, with its harmonics at a load [N]; None if nothing.

    Raises:
        ResourceError: see `read_stiffness_table`.
    """
    stated = read_header(file, "uncertainty", 1 + STATED_HARMONICS)
    if np.isnan(stated).any():
        return None
    loads, stiffness = read_stiffness_table(file)[0]
    row = stiffness[np.abs(loads - load).argmin()]
    amplitudes = mesh_harmonics(row)[:STATED_HARMONICS]
    return Uncertainty(float(stated[0]), stated[1:], amplitudes / row.mean())


def mesh_harmonics(stiffness: np.ndarray) -> np.ndarray:
    """Amplitudes (..., n//2) of the harmonics 1 to n//2 of stiffnesses (..., n) over a mesh.

    The last one of an even number of phases has no mirror image.
    """
    count = stiffness.shape[-1]
    amplitudes = np.abs(np.fft.rfft(stiffness, axis=-1))[..., 1:] * 2.0 / count
    if count % 2 == 0:
        amplitudes[..., -1] *= 0.5
    return amplitudes
