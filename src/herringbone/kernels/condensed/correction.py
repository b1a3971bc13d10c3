"""Correction of the laws' inputs over one step, from residuals at its nodes."""

from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inlined
from herringbone.kernels.condensed.collocation import Nodes, Table
from herringbone.kernels.condensed.lines import aligned
from herringbone.kernels.condensed.modal import add_product, copy, solve

_SWEPT = 0.1
"""Change by a sweep, over the largest correction, after which they end: the next is far smaller."""
_MOST_SWEEPS = 8


class Room(NamedTuple):
    """Room for the correction of a step.

    Attributes:
        matrix: (unknowns x nodes, the same).
        r: (unknowns x nodes,) residuals, then corrections.
        x: of the same length.
        miss: (unknowns,) what a node's corrections lack.
        answers: (nodes x tangents,) along the directions of the tangents.
    """

    matrix: np.ndarray
    r: np.ndarray
    x: np.ndarray
    miss: np.ndarray
    answers: np.ndarray


def make_room(unknowns: int, inner: int, tangents: int) -> Room:
    """Room for so many unknowns at so many nodes, and so many tangents at each."""
    size = unknowns * inner
    return Room(
        aligned(size, size),
        aligned(size),
        aligned(size),
        aligned(unknowns),
        aligned(inner * tangents),
    )


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
    table: Table, nodes: Nodes, along: np.ndarray, first: int, r: np.ndarray, room: Room
) -> bool:
    """Write corrections to `room.x` by sweeps over the nodes in the order of time.

    What the laws give at a node acts on later ones far more than on earlier ones, so that one or
    two sweeps (Gauss and Seidel, a node at once) do.

    Args:
        table, nodes, along: see `correct`.
        first: unknown with which `r` begins.
        r: residuals.
        room: its answers are those of all directions to the corrections so far.

    Returns:
        False if the sweeps do not end.
    """
    inner, tangents = nodes.k.shape
    begin, unknowns = first * inner, r.size // inner
    x, miss, answers = room.x, room.miss, room.answers
    copy(r, x[: r.size])
    for i in range(answers.size):
        answers[i] = 0.0
    add_product(along[begin : begin + r.size], r, answers)
    for _ in range(_MOST_SWEEPS):
        change, largest = 0.0, 0.0
        for i in range(inner):
            k, of_node = nodes.k[i], answers[i * tangents : (i + 1) * tangents]
            for n in range(unknowns):
                miss[n] = r[n * inner + i] - x[n * inner + i]
            for t in range(tangents):
                n = table.unknown[table.value[t]] - first
                if 0 <= n < unknowns:
                    miss[n] += (k[t] - table.mean[t]) * of_node[t]
            for n in range(unknowns):
                row, by = n * inner + i, miss[n]
                x[row] += by
                change, largest = max(change, abs(by)), max(largest, abs(x[row]))
                column = along[begin + row]
                for m in range(answers.size):
                    answers[m] += column[m] * by
        if change <= _SWEPT * largest:
            return True
    return False


@inlined
def _eliminate(
    table: Table, nodes: Nodes, along: np.ndarray, first: int, matrix: np.ndarray, r: np.ndarray
) -> None:
    """Replace residuals by corrections; arguments as of `_swept`, and room for a matrix."""
    inner, tangents = nodes.k.shape
    begin, size = first * inner, r.size
    for row in range(size):
        for column in range(size):
            matrix[row, column] = 0.0
        matrix[row, row] = 1.0
    for t in range(tangents):
        place = (table.unknown[table.value[t]] - first) * inner
        if 0 <= place < size:
            for i in range(inner):
                rest = nodes.k[i, t] - table.mean[t]
                for column in range(size):
                    matrix[place + i, column] -= rest * along[begin + column, i * tangents + t]
    solve(matrix, r)


@inlined
def correct(table: Table, nodes: Nodes, along: np.ndarray, room: Room) -> None:
    """Replace residuals by the corrections of the inputs, by one step of Newton.

    Args:
        table, nodes: with tangents.
        along: (unknowns x nodes, nodes x tangents) what each input does along the directions of the
            tangents at all nodes.
        room: with residuals.
    """
    inner = len(nodes.z)
    first, end = _bent(table, nodes, room.r)
    if end <= first:
        return
    r = room.r[first * inner : end * inner]
    if _swept(table, nodes, along, first, r, room):
        copy(room.x, r)
    else:
        _eliminate(table, nodes, along, first, room.matrix, r)
