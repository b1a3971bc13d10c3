"""What the gear mesh reads, and what it refuses: files that are not of this pair."""

from dataclasses import replace

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.resources import (
    pair_law,
    stiffness_table,
    tooth_deviations,
    transmission_error,
)
from herringbone.components.resources.loader import NO_FILE, Refusal, ResourceLoader
from herringbone.kernels import force_law, tooth_pair_law
from herringbone.kernels.compiling.jit import kernel, seldom

_SAME, _SAME_RATIO = 1e-4, 1e-3  # relative
_NUMBERS = stiffness_table.PAIR[1]
_OF_TABLE = len(stiffness_table.REFUSALS)
_OF_ERRORS = _OF_TABLE + len(transmission_error.REFUSALS)
_OF_DEVIATIONS = _OF_ERRORS + len(tooth_deviations.REFUSALS)
_NO_TEETH = _OF_DEVIATIONS + len(pair_law.REFUSALS) + 1
_OTHER_TABLE, _OTHER_LAW, _NO_LAW = _NO_TEETH + 1, _NO_TEETH + 2, _NO_TEETH + 3
_TABLE, _ERRORS, _DEVIATIONS, _LAW = range(4)
_PAIR = "z %g/%g, base radii %.7g/%.7g m, base helix angle %.7g rad, face width %.7g m"
_REFUSALS = (
    *stiffness_table.REFUSALS,
    *transmission_error.REFUSALS,
    *(replace(refusal, text=_DEVIATIONS) for refusal in tooth_deviations.REFUSALS),
    *(replace(refusal, text=_LAW) for refusal in pair_law.REFUSALS),
    Refusal(
        "teeth %g/%g do not fit base radii %.7g/%.7g m (ratio %.7g against %.7g); set those of one "
        "pair",
        NO_FILE,
    ),
    Refusal(
        f" is the table of the pair {_PAIR}; the parameters are of {_PAIR}; set the table and the "
        "parameters of one pair"
    ),
    Refusal(
        f" is the law of teeth of the pair {_PAIR}; the parameters are of {_PAIR}; set the law and "
        "the parameters of one pair",
        _LAW,
    ),
    Refusal(
        " has no law of a pair of teeth, which deviations of teeth need; set pair_law to one of "
        "this pair",
        _LAW,
    ),
)


@seldom
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
    file = stiffness_table.SIZE + rows * shape[1]
    refusal = transmission_error.collect(values[file:], shape[2], b, at.ERRORS, report)
    if refusal:
        return refusal + _OF_TABLE
    file += (1 + shape[2]) * shape[3]
    refusal = tooth_deviations.collect(values[file:], shape[4], b, at.DEVIATIONS, report)
    if refusal:
        return refusal + _OF_ERRORS
    file += (1 + shape[4]) * shape[5]
    return _load_law(values[file:], shape[6], shape[7], b, s, report)


@kernel
def _load_law(
    values: np.ndarray, rows: int, width: int, b: np.ndarray, s: np.ndarray, report: np.ndarray
) -> int:
    """Turn the law of a pair of teeth into those of both sides."""
    if not pair_law.is_law(values):
        return 0
    refusal = pair_law.check(values, rows, width, report)
    if refusal:
        return refusal + _OF_DEVIATIONS
    b[at.LAW_PAIR] = 1.0
    for k in range(_NUMBERS):
        b[at.LAW_PAIR + 1 + k] = values[pair_law.PAIR_AT + k]
    b[at.TRANSVERSE], b[at.OVERLAP] = pair_law.contact_ratios(values)
    for side in range(2):
        table = at.TABLE[0] + side * force_law.TABLE_SIZE
        law = at.LAW[0] + side * tooth_pair_law.TABLE_SIZE
        pair_law.place(values, rows, b, law, table, s)
    return 0


@kernel
def _same(a: float, b: float, tolerance: float) -> bool:
    return abs(a - b) <= tolerance * max(abs(a), abs(b))


@kernel
def _is_pair(b: np.ndarray, pair: int, report: np.ndarray) -> bool:
    """True if the numbers of a file's pair, at `b[pair:]`, are those of the parameters."""
    for gear in range(2):
        report[_NUMBERS + gear] = b[at.TEETH[gear]]
        report[_NUMBERS + 2 + gear] = b[at.RB[gear]]
    report[_NUMBERS + 4], report[_NUMBERS + 5] = abs(b[at.BETA]), b[at.FACE_WIDTH]
    same = True
    for k in range(_NUMBERS):
        report[k] = abs(b[pair + k])
        tolerance = 0.0 if k < 2 else _SAME
        same = same and _same(report[k], report[_NUMBERS + k], tolerance)
    return same


@kernel
def _check(b: np.ndarray, report: np.ndarray) -> int:
    """Refuse teeth that do not fit the base radii, and files of another pair."""
    z, rb = at.TEETH, at.RB
    if not _same(b[z[0]] * b[rb[1]], b[z[1]] * b[rb[0]], _SAME_RATIO):
        report[0], report[1], report[2], report[3] = b[z[0]], b[z[1]], b[rb[0]], b[rb[1]]
        report[4], report[5] = b[z[1]] / b[z[0]], b[rb[1]] / b[rb[0]]
        return _NO_TEETH
    b[at.PAIR_KNOWN] = b[at.PAIR]
    if b[at.PAIR] > 0.0 and not _is_pair(b, at.PAIR + 1, report):
        return _OTHER_TABLE
    if b[at.DEVIATIONS] == 0.0:
        return 0
    if b[at.LAW_PAIR] == 0.0:
        return _NO_LAW
    if not _is_pair(b, at.LAW_PAIR + 1, report):
        return _OTHER_LAW
    refusal = tooth_deviations.check(b, at.DEVIATIONS, b[z[0]], b[z[1]], report)
    return refusal + _OF_ERRORS if refusal else 0


LOADER = ResourceLoader(
    at.DECLARATION.texts,
    _load,
    _REFUSALS,
    stiffness_table.SCRATCH_SIZE + force_law.SCRATCH_SIZE,
    _check,
)
