"""Collocation of laws over one step: residuals at the nodes.

Nodes are those of Lobatto, the start of the step included. Unknown are the values of the laws, less
mean tangents times arguments, at all nodes but the first. Inputs of a step are the values of all
channels at all nodes, channel by channel.
"""

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np

from herringbone.kernels.compiling.jit import inlined
from herringbone.kernels.condensed.modal import add_product

_ROUNDED = 1e-13
"""Of an input: a residual below is rounding, as of a law that has given nothing but zero so far."""


class Table(NamedTuple):
    """Where the laws' values and tangents lie, by value or tangent.

    Attributes:
        first: (values + 1,) where the mean tangents of a value begin.
        argument, tangent: which argument, and the mean tangent over it, of all that are not zero.
        value: (tangents,) whose tangent it is.
        mean: (tangents,).
        unknown: (values,) row of a stiff value among the unknowns, else -1.
        scale: (values,) largest size that each had, so far.
        least: (channels,) size of a value, or of its change over a step, that moves no coordinate
            by a share of the tolerance of what the stiff values do; 0 of other channels.
    """

    first: np.ndarray
    argument: np.ndarray
    tangent: np.ndarray
    value: np.ndarray
    mean: np.ndarray
    unknown: np.ndarray
    scale: np.ndarray
    least: np.ndarray

    @classmethod
    def of(
        cls,
        tangent: np.ndarray,
        value: Sequence[int],
        mean: np.ndarray,
        stiff: Sequence[int],
        channels: int,
    ) -> Self:
        """Of mean tangents (values, arguments) and the stiff values; none has had a size so far."""
        values = len(tangent)
        unknown = np.full(values, -1)
        unknown[list(stiff)] = np.arange(len(stiff))
        owners = np.array(value, dtype=np.int64)
        scale, least = np.full(values, np.finfo(float).tiny), np.zeros(channels)
        return cls(*_not_zero(tangent), owners, mean, unknown, scale, least)


class Nodes(NamedTuple):
    """What the laws give at the nodes of a step.

    Attributes:
        z: (nodes - 1, arguments).
        f: (nodes - 1, values).
        k: (nodes - 1, tangents).
        e: (nodes, indicators), the start included.
        start: (arguments,) at the start.
    """

    z: np.ndarray
    f: np.ndarray
    k: np.ndarray
    e: np.ndarray
    start: np.ndarray


@inlined
def less_tangents(table: Table, value: int, force: float, z: np.ndarray) -> float:
    """A value less its mean tangents times the arguments."""
    for k in range(table.first[value], table.first[value + 1]):
        force -= table.tangent[k] * z[table.argument[k]]
    return force


@inlined
def residuals(table: Table, nodes: Nodes, u: np.ndarray, r: np.ndarray) -> float:
    """What the values at the nodes differ from the inputs; returns the largest, over its scale.

    Stiff values stand in `r` (unknowns x nodes); the inputs of the others, in `u` (channels,
    nodes), are replaced at once.
    """
    inner = len(nodes.z)
    largest = 0.0
    for value in range(table.unknown.size):
        unknown, own = table.unknown[value], u[value, 1:]
        if unknown < 0:
            for i in range(inner):
                own[i] = nodes.f[i, value]
            continue
        to = r[unknown * inner : (unknown + 1) * inner]
        scale, off = table.scale[value], 0.0
        for i in range(inner):
            force = nodes.f[i, value]
            scale = max(scale, abs(force))
            # the input last, so that a solution leaves nothing, not even rounding
            miss = less_tangents(table, value, force, nodes.z[i]) - own[i]
            to[i] = miss
            if not abs(miss) <= max(off, _ROUNDED * abs(own[i])):
                off = abs(miss)
        table.scale[value] = scale
        if not off <= largest * scale:
            largest = off / scale
    return largest


class Sharp(NamedTuple):
    """Directions along which arguments are taken at all nodes; others are linear over a step.

    Attributes:
        at: (nodes,) places in a step.
        first: (n + 1,) where each direction begins.
        argument, coefficient: of what is not zero in them.
        back: (n, arguments) their pseudo-inverse, transposed.
    """

    at: np.ndarray
    first: np.ndarray
    argument: np.ndarray
    coefficient: np.ndarray
    back: np.ndarray

    @classmethod
    def of(cls, nodes: np.ndarray, directions: np.ndarray) -> Self:
        """Of directions (n, arguments)."""
        back = np.ascontiguousarray(np.linalg.pinv(directions).T)
        return cls(nodes, *_not_zero(directions), back)


def _not_zero(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where each row begins, then columns and values of what is not zero."""
    rows, columns = np.nonzero(matrix)
    first = np.searchsorted(rows, np.arange(len(matrix) + 1))
    return first.astype(np.int64), columns.astype(np.int64), matrix[rows, columns]


@inlined
def spread(sharp: Sharp, nodes: Nodes, rows: np.ndarray) -> None:
    """Write arguments at all nodes from those at the end, and along sharp directions.

    Args:
        sharp: directions.
        nodes: with arguments at the start; `z` is written.
        rows: along the directions at all nodes but start and end, then arguments at the end;
            changed.
    """
    count, arguments = sharp.back.shape
    last = len(nodes.z) - 1
    end, first = nodes.z[last], last * count
    for a in range(arguments):
        end[a] = rows[first + a]
    for k in range(count):
        before, change = 0.0, 0.0
        for n in range(sharp.first[k], sharp.first[k + 1]):
            a, by = sharp.argument[n], sharp.coefficient[n]
            before += by * nodes.start[a]
            change += by * (end[a] - nodes.start[a])
        for i in range(last):
            rows[i * count + k] -= before + sharp.at[i + 1] * change
    for i in range(last):
        c, z = sharp.at[i + 1], nodes.z[i]
        for a in range(arguments):
            z[a] = nodes.start[a] + c * (end[a] - nodes.start[a])
        add_product(sharp.back, rows[i * count : (i + 1) * count], z)


@inlined
def turned(nodes: Nodes, between: np.ndarray) -> bool:
    """True if an indicator changes its sign in the step.

    Also twice between two nodes, see `hidden`.

    Args:
        nodes: of the step.
        between: (nodes - 1, nodes) values midway, of the polynomial through those at the nodes.
    """
    for i in range(len(nodes.z)):
        for j in range(len(nodes.e[0])):
            if nodes.e[i, j] * nodes.e[i + 1, j] < 0.0:
                return True
    for j in range(len(nodes.e[0])):
        if hidden(nodes.e, j, between) >= 0:
            return True
    return False


@inlined
def hidden(e: np.ndarray, j: int, between: np.ndarray) -> int:
    """Node after which an indicator of one sign at all nodes has another one, then not; -1: none.

    So does a contact that is over at the next node. It shows in the vertex of the parabola through
    both nodes and the place midway.

    Args:
        e: (nodes, indicators).
        j: which indicator.
        between: see `turned`.
    """
    least = most = abs(e[0, j])
    for i in range(len(between)):
        size = abs(e[i + 1, j])
        least, most = min(least, size), max(most, size)
    if least >= most - least:
        return -1
    for i in range(len(between)):
        middle = 0.0
        for k in range(len(e)):
            middle += between[i, k] * e[k, j]
        start, end = e[i, j], e[i + 1, j]
        bend, slope = 0.5 * (start - 2.0 * middle + end), 0.5 * (end - start)
        vertex = middle
        if abs(slope) < 2.0 * abs(bend):
            vertex -= 0.25 * slope * slope / bend
        if vertex * start < 0.0:
            return i
    return -1
