"""What the gear mesh reads, and what it refuses: tables that are not of this pair."""

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.resources import stiffness_table, transmission_error
from herringbone.components.resources.loader import NO_FILE, Refusal, ResourceLoader
from herringbone.kernels import force_law
from herringbone.kernels.jit import kernel

_SAME, _SAME_RATIO = 1e-4, 1e-3  # relative
_NUMBERS = stiffness_table.PAIR[1]
_OF_TABLE = len(stiffness_table.REFUSALS)
_NO_TEETH = _OF_TABLE + len(transmission_error.REFUSALS) + 1
_PAIR = "z %g/%g, base radii %.7g/%.7g m, base helix angle %.7g rad, face width %.7g m"
_REFUSALS = (
    *stiffness_table.REFUSALS,
    *transmission_error.REFUSALS,
    Refusal(
        "teeth %g/%g do not fit base radii %.7g/%.7g m (ratio %.7g against %.7g); set those of one "
        "pair",
        NO_FILE,
    ),
    Refusal(
        f" is the table of the pair {_PAIR}; the parameters are of {_PAIR}; set the table and the "
        "parameters of one pair"
    ),
)


@kernel
def _load(
    values: np.ndarray, shape: np.ndarray, b: np.ndarray, s: np.ndarray, report: np.ndarray
) -> int:
    """Turn the stiffness table into the force laws of both meshes; keep pair and errors."""
    rows = shape[0]
    for side in range(2):
        refusal, loads, phases = stiffness_table.collect(values, rows, side, s, report)
        if refusal:
            return refusal
        stiffness, scratch = s[stiffness_table.GRID :], s[stiffness_table.SCRATCH_SIZE :]
        table = at.TABLE[0] + side * force_law.TABLE_SIZE
        force_law.build(s[:loads], stiffness, phases, b, table, scratch)
    first = stiffness_table.PAIR_AT
    if values[first] == values[first]:
        b[at.PAIR] = 1.0
        for k in range(_NUMBERS):
            b[at.PAIR + 1 + k] = values[first + k]
    second = values[stiffness_table.SIZE + rows * shape[1] :]
    refusal = transmission_error.collect(second, shape[2], b, at.ERRORS, report)
    return refusal + _OF_TABLE if refusal else 0


@kernel
def _same(a: float, b: float, tolerance: float) -> bool:
    return abs(a - b) <= tolerance * max(abs(a), abs(b))


@kernel
def _check(b: np.ndarray, report: np.ndarray) -> int:
    """Refuse teeth that do not fit the base radii, and the table of another pair."""
    z, rb = at.TEETH, at.RB
    if not _same(b[z[0]] * b[rb[1]], b[z[1]] * b[rb[0]], _SAME_RATIO):
        report[0], report[1], report[2], report[3] = b[z[0]], b[z[1]], b[rb[0]], b[rb[1]]
        report[4], report[5] = b[z[1]] / b[z[0]], b[rb[1]] / b[rb[0]]
        return _NO_TEETH
    b[at.PAIR_KNOWN] = b[at.PAIR]
    if b[at.PAIR] == 0.0:
        return 0
    for gear in range(2):
        report[_NUMBERS + gear], report[_NUMBERS + 2 + gear] = b[z[gear]], b[rb[gear]]
    report[_NUMBERS + 4], report[_NUMBERS + 5] = abs(b[at.BETA]), b[at.FACE_WIDTH]
    same = True
    for k in range(_NUMBERS):
        report[k] = abs(b[at.PAIR + 1 + k])
        tolerance = 0.0 if k < 2 else _SAME
        same = same and _same(report[k], report[_NUMBERS + k], tolerance)
    return 0 if same else _NO_TEETH + 1


LOADER = ResourceLoader(
    at.DECLARATION.texts,
    _load,
    _REFUSALS,
    stiffness_table.SCRATCH_SIZE + force_law.SCRATCH_SIZE,
    _check,
)
