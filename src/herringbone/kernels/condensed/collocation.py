"""Collocation of laws over one step: residuals at the nodes, and their correction.

Nodes are those of Lobatto, the start of the step included. Unknown are the values of the laws, less
mean tangents times arguments, at all nodes but the first. Inputs of a step are the values of all
channels at all nodes, channel by channel.
"""

from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inlined
from herringbone.kernels.condensed.modal import solve


class Table(NamedTuple):
    """Where the laws' values and tangents lie, by value or tangent.

    Attributes:
        first: (values + 1,) where the mean tangents of a value begin.
        argument, tangent: which argument, and the mean tangent over it, of all that are not zero.
        value: (tangents,) whose tangent it is.
        mean: (tangents,).
        unknown: (values,) row of a stiff value among the unknowns, else -1.
        scale: (values,) largest size that each had, so far.
    """

    first: np.ndarray
    argument: np.ndarray
    tangent: np.ndarray
    value: np.ndarray
    mean: np.ndarray
    unknown: np.ndarray
    scale: np.ndarray


class Nodes(NamedTuple):
    """What the laws give at the nodes of a step.

    Attributes:
        z: (nodes - 1, arguments).
        f: (nodes - 1, values).
        k: (nodes - 1, tangents).
        e: (nodes, indicators), the start included.
    """

    z: np.ndarray
    f: np.ndarray
    k: np.ndarray
    e: np.ndarray


class Room(NamedTuple):
    """Room for the correction of a step.

    Attributes:
        matrix, right: (unknowns x nodes, the same), (unknowns x nodes,).
        r: (unknowns x nodes,) residuals, then corrections.
        bent: (unknowns,) unknowns whose tangents differ from their means.
        row: (unknowns,) place of an unknown among these, else -1.
    """

    matrix: np.ndarray
    right: np.ndarray
    r: np.ndarray
    bent: np.ndarray
    row: np.ndarray


def make_room(unknowns: int, inner: int) -> Room:
    """Room for so many unknowns at so many nodes."""
    size = unknowns * inner
    return Room(
        np.empty((size, size)),
        np.empty(size),
        np.empty(size),
        np.empty(unknowns, dtype=np.int64),
        np.empty(unknowns, dtype=np.int64),
    )


@inlined
def less_tangents(table: Table, value: int, force: float, z: np.ndarray) -> float:
    """A value less its mean tangents times the arguments."""
    for k in range(table.first[value], table.first[value + 1]):
        force -= table.tangent[k] * z[table.argument[k]]
    return force


@inlined
def residuals(table: Table, nodes: Nodes, u: np.ndarray, r: np.ndarray) -> float:
    """What the values at the nodes differ from the inputs; returns the largest, over its scale.

    Stiff values stand in `r` (unknowns x nodes); the inputs of the others are replaced at once.
    """
    inner = len(nodes.z)
    largest = 0.0
    for value in range(table.unknown.size):
        row, scale = table.unknown[value], table.scale[value]
        off = 0.0
        for i in range(inner):
            force = nodes.f[i, value]
            scale = max(scale, abs(force))
            rest = less_tangents(table, value, force, nodes.z[i])
            place = value * (inner + 1) + i + 1
            if row >= 0:
                miss = rest - u[place]
                r[row * inner + i] = miss
                if not abs(miss) <= off:
                    off = abs(miss)
            else:
                u[place] = rest
        table.scale[value] = scale
        if not off <= largest * scale:
            largest = off / scale
    return largest


@inlined
def _bent(table: Table, nodes: Nodes, room: Room) -> int:
    """Number the unknowns whose tangents differ from their means; returns how many."""
    for row in range(room.row.size):
        room.row[row] = -1
    count = 0
    for t in range(table.value.size):
        row = table.unknown[table.value[t]]
        for i in range(len(nodes.z)):
            if room.row[row] < 0 and nodes.k[i, t] != table.mean[t]:
                room.row[row] = count
                room.bent[count] = row
                count += 1
    return count


@inlined
def _bend_rows(
    nodes: Nodes, along: np.ndarray, room: Room, t: int, first: int, mean: float
) -> None:
    """Add what one tangent's differences from its mean make of the rows from the first one on."""
    inner, matrix, r = len(nodes.z), room.matrix, room.r
    for i in range(inner):
        rest = nodes.k[i, t] - mean
        row = first + i
        for unknown in range(room.row.size):
            at = room.row[unknown]
            for n in range(inner):
                column = unknown * inner + n
                if at >= 0:
                    matrix[row, at * inner + n] -= rest * along[i, t, column]
                elif r[column] != 0.0:
                    room.right[row] += rest * along[i, t, column] * r[column]


@inlined
def correct(table: Table, nodes: Nodes, along: np.ndarray, room: Room) -> None:
    """Replace residuals by the corrections of the inputs, by one step of Newton.

    Unknowns whose tangents are the means are corrected by their residuals: their row of the matrix
    is that of the identity.

    Args:
        table, nodes: with tangents.
        along: (nodes - 1, tangents, unknowns x nodes): directions of the tangents over the inputs.
        room: with residuals.
    """
    inner = len(nodes.z)
    count = _bent(table, nodes, room)
    matrix, right, r = room.matrix, room.right, room.r
    for k in range(count * inner):
        right[k] = r[room.bent[k // inner] * inner + k % inner]
        for j in range(count * inner):
            matrix[k, j] = 1.0 if k == j else 0.0
    for t in range(table.value.size):
        place = room.row[table.unknown[table.value[t]]]
        if place >= 0:
            _bend_rows(nodes, along, room, t, place * inner, table.mean[t])
    solve(matrix, right, count * inner)
    for k in range(count):
        for i in range(inner):
            r[room.bent[k] * inner + i] = right[k * inner + i]


@inlined
def turned(nodes: Nodes) -> bool:
    """True if an indicator changes its sign between two nodes of the step."""
    for i in range(len(nodes.z)):
        for j in range(len(nodes.e[0])):
            if nodes.e[i, j] * nodes.e[i + 1, j] < 0.0:
                return True
    return False
