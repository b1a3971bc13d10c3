"""Correction of the laws' inputs over one step, from residuals at its nodes."""

from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inlined
from herringbone.kernels.condensed.collocation import Nodes, Table
from herringbone.kernels.condensed.modal import copy, solve

_SWEPT = 0.1
"""Change by a sweep, over the largest correction, after which they end: the next is far smaller."""
_MOST_SWEEPS = 8


class Room(NamedTuple):
    """Room for the correction of a step.

    Attributes:
        matrix: (unknowns x nodes, the same).
        r: (unknowns x nodes,) residuals, then corrections.
        x: of the same length.
    """

    matrix: np.ndarray
    r: np.ndarray
    x: np.ndarray


def make_room(unknowns: int, inner: int) -> Room:
    """Room for so many unknowns at so many nodes."""
    size = unknowns * inner
    return Room(np.empty((size, size)), np.empty(size), np.empty(size))


@inlined
def _bent(table: Table, nodes: Nodes, r: np.ndarray) -> tuple[int, int]:
    """First unknown, and the one after the last, that a correction is to be solved for.

    All others have tangents that are their means, and no residual.
    """
    inner = len(nodes.z)
    first, end = r.size // inner, 0
    for t in range(table.value.size):
        unknown = table.unknown[table.value[t]]
        if first <= unknown < end:
            continue
        off = 0.0
        for i in range(inner):
            off += abs(nodes.k[i, t] - table.mean[t]) + abs(r[unknown * inner + i])
        if off != 0.0:
            first, end = min(first, unknown), max(end, unknown + 1)
    return first, end


@inlined
def _swept(
    table: Table, nodes: Nodes, along: np.ndarray, first: int, r: np.ndarray, x: np.ndarray
) -> bool:
    """Write corrections to `x` by sweeps over the nodes in the order of time (Gauss and Seidel).

    What the laws give at a node acts on later ones far more than on earlier ones, so that one or
    two sweeps do.

    Args:
        table, nodes, along: see `correct`.
        first: unknown with which `r` begins.
        r: residuals.

    Returns:
        False if the sweeps do not end.
    """
    inner, begin, size = len(nodes.z), first * len(nodes.z), r.size
    copy(r, x)
    for _ in range(_MOST_SWEEPS):
        change, largest = 0.0, 0.0
        for i in range(inner):
            for row in range(i, size, inner):
                unknown, miss = first + row // inner, r[row] - x[row]
                for t in range(table.value.size):
                    if table.unknown[table.value[t]] == unknown:
                        own, answer = along[i, t, begin : begin + size], 0.0
                        for column in range(size):
                            answer += own[column] * x[column]
                        miss += (nodes.k[i, t] - table.mean[t]) * answer
                x[row] += miss
                change, largest = max(change, abs(miss)), max(largest, abs(x[row]))
        if change <= _SWEPT * largest:
            return True
    return False


@inlined
def _eliminate(
    table: Table, nodes: Nodes, along: np.ndarray, first: int, matrix: np.ndarray, r: np.ndarray
) -> None:
    """Replace residuals by corrections; arguments as of `_swept`, and room for a matrix."""
    inner, begin, size = len(nodes.z), first * len(nodes.z), r.size
    for row in range(size):
        for column in range(size):
            matrix[row, column] = 0.0
        matrix[row, row] = 1.0
    for t in range(table.value.size):
        place = (table.unknown[table.value[t]] - first) * inner
        if 0 <= place < size:
            for i in range(inner):
                rest = nodes.k[i, t] - table.mean[t]
                for column in range(size):
                    matrix[place + i, column] -= rest * along[i, t, begin + column]
    solve(matrix, r)


@inlined
def correct(table: Table, nodes: Nodes, along: np.ndarray, room: Room) -> None:
    """Replace residuals by the corrections of the inputs, by one step of Newton.

    Args:
        table, nodes: with tangents.
        along: (nodes - 1, tangents, unknowns x nodes): directions of the tangents over the inputs.
        room: with residuals.
    """
    inner = len(nodes.z)
    first, end = _bent(table, nodes, room.r)
    if end <= first:
        return
    r, x = room.r[first * inner : end * inner], room.x[: (end - first) * inner]
    if _swept(table, nodes, along, first, r, x):
        copy(x, r)
    else:
        _eliminate(table, nodes, along, first, room.matrix, r)
