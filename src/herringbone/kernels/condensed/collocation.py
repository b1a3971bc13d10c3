"""Collocation of laws over one step: residuals at the nodes, and the matrix of their iteration.

Nodes are those of Lobatto, the start of the step included. Unknown are the values of the laws, less
mean tangents times arguments, at all nodes but the first. Inputs of a step are the values of all
channels at all nodes, channel by channel.
"""

from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inlined


class Table(NamedTuple):
    """Where the laws' values and tangents lie, by value or tangent.

    Attributes:
        tangent: (values, arguments), mean tangents.
        value: (tangents,) whose tangent it is.
        mean: (tangents,).
        unknown: (values,) row of a stiff value among the unknowns, else -1.
        scale: (values,) largest size that each had, so far.
    """

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


@inlined
def residuals(table: Table, nodes: Nodes, u: np.ndarray, r: np.ndarray) -> float:
    """What the values at the nodes differ from the inputs; returns the largest, over its scale.

    Stiff values stand in `r` (unknowns x nodes); the inputs of the others are replaced at once.
    """
    inner = len(nodes.z)
    largest = 0.0
    for value in range(table.unknown.size):
        row = table.unknown[value]
        for i in range(inner):
            force = nodes.f[i, value]
            table.scale[value] = max(table.scale[value], abs(force))
            rest = force
            if row >= 0:
                for j in range(len(nodes.z[i])):
                    rest -= table.tangent[value, j] * nodes.z[i, j]
            place = value * (inner + 1) + i + 1
            if row >= 0:
                r[row * inner + i] = rest - u[place]
                if not abs(r[row * inner + i]) <= largest * table.scale[value]:
                    largest = abs(r[row * inner + i]) / table.scale[value]
            else:
                u[place] = rest
    return largest


@inlined
def iteration_matrix(table: Table, nodes: Nodes, along: np.ndarray, a: np.ndarray) -> None:
    """Derivative of inputs less values, over the stiff inputs at all nodes but the first.

    Args:
        table, nodes: with tangents.
        along: (nodes - 1, tangents, unknowns x nodes): directions of the tangents over the inputs.
        a: receives the matrix.
    """
    inner, size = len(nodes.z), len(a)
    for row in range(size):
        for column in range(size):
            a[row, column] = 1.0 if row == column else 0.0
    for t in range(table.value.size):
        first = table.unknown[table.value[t]] * inner
        for i in range(inner):
            rest = nodes.k[i, t] - table.mean[t]
            if rest != 0.0:
                for column in range(size):
                    a[first + i, column] -= rest * along[i, t, column]


@inlined
def turned(nodes: Nodes) -> bool:
    """True if an indicator changes its sign between two nodes of the step."""
    for i in range(len(nodes.z)):
        for j in range(len(nodes.e[0])):
            if nodes.e[i, j] * nodes.e[i + 1, j] < 0.0:
                return True
    return False
