"""Parts of a step, each repeated by itself, so that its cost can be measured."""

import numpy as np

from herringbone.analysis.twin.condensed.laws import call_laws
from herringbone.analysis.twin.condensed.march_arrays import Arrays
from herringbone.analysis.twin.condensed.products import (
    add_of_inputs,
    add_of_state,
    add_push,
    coordinates,
)
from herringbone.analysis.twin.condensed.rungs import Rungs
from herringbone.kernels.compiling.jit import allocating
from herringbone.kernels.condensed.channels import inputs
from herringbone.kernels.condensed.collocation import residuals, spread
from herringbone.kernels.condensed.correction import correct


@allocating
def laws(count: int, arrays: Arrays, t: float) -> None:
    """All laws at the nodes, at a time [s]."""
    nodes = arrays.nodes
    for _ in range(count):
        for i in range(len(nodes.z)):
            call_laws(arrays.calls, t, nodes.z[i], nodes.f[i], nodes.k[i], nodes.e[i + 1])


@allocating
def given(arrays: Arrays) -> tuple[np.ndarray, np.ndarray, int]:
    """Inputs of the last step, places of those that are not zero, how many of them the laws'."""
    nodes, count = arrays.fixed.nodes, arrays.fixed.nodes.size
    u = arrays.state.u.reshape(arrays.state.u.size // count, count)
    v, chosen = np.zeros_like(u), np.empty(u.size, dtype=np.int64)
    laws = inputs(nodes, arrays.table.least, u, 0, arrays.table.unknown.size, v, chosen)
    every = inputs(nodes, arrays.table.least, u, 0, len(u), v, chosen)
    return v.reshape(v.size), chosen[:every], laws


@allocating
def products(
    count: int,
    arrays: Arrays,
    rungs: Rungs,
    given: np.ndarray,
    chosen: np.ndarray,
    laws: int,
) -> None:
    """Rows of the coordinates and of the laws' inputs, and the coordinates at the end."""
    rows, q = np.zeros(rungs.rows.shape[2]), np.zeros(rungs.push.shape[2])
    for _ in range(count):
        add_of_state(rungs, 0, arrays.state.q[: coordinates(rungs)], rows)
        add_of_inputs(rungs, 0, given, chosen, laws, rows)
        add_push(rungs, 0, given, chosen, chosen.size, q)


@allocating
def arguments(count: int, arrays: Arrays) -> None:
    """Arguments of the laws at the nodes."""
    rows = np.zeros(arrays.fixed.offset.size)
    for _ in range(count):
        spread(arrays.fixed.sharp, arrays.nodes, rows)


@allocating
def corrections(count: int, arrays: Arrays, rungs: Rungs) -> None:
    """Residuals, and what they change."""
    nodes = arrays.nodes
    u = arrays.state.u.reshape(arrays.state.u.size // len(nodes.e), len(nodes.e))
    for _ in range(count):
        residuals(arrays.table, nodes, u, arrays.room.r)
        correct(arrays.table, nodes, rungs.along[0], arrays.room)
