"""The compiled march: steps of the condensed core, laws called by their addresses."""

import numpy as np

from herringbone.analysis.twin.condensed.march_arrays import Calls, Fixed, Samples, State
from herringbone.analysis.twin.condensed.rungs import Rungs
from herringbone.cosim.loops.calls import c_call
from herringbone.kernels.compiling.jit import allocating, inlined, kernel
from herringbone.kernels.condensed.collocation import (
    Nodes,
    Table,
    iteration_matrix,
    residuals,
    turned,
)
from herringbone.kernels.condensed.modal import add_inputs, add_rows, copy, fill, solve, turn

DONE, NOT_CONVERGED, NOT_FINITE = 0, 1, 2
"""Status of a march."""
MOST_ITERATIONS = 8
STEPS, HALVINGS, EVALUATIONS = 0, 1, 2
"""What is counted."""
_CLOSE = 1e-8
"""Residual of the laws' values, over their size, whose correction solves a step.

Every correction makes it a thousand times smaller, or more, wherever no law bends."""
_REAL = 8

_call_law = c_call("address", "address", "address", "address", "address")
_call_signals = c_call("address", "real")


@inlined
def _call_laws(calls: Calls, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray) -> None:
    """Values, tangents and indicators of all laws at their arguments."""
    blocks = calls.blocks.ctypes.data
    for p in range(calls.law.size):
        _call_law(
            calls.law[p],
            (
                blocks + _REAL * calls.block[p],
                z.ctypes.data + _REAL * calls.argument[p],
                f.ctypes.data + _REAL * calls.value[p],
                k.ctypes.data + _REAL * calls.tangent[p],
                e.ctypes.data + _REAL * calls.indicator[p],
            ),
        )


@kernel
def call_sources(calls: Calls, t: float) -> None:
    """Let the sources write their signals at a time [s] into their blocks."""
    for k in range(calls.source.size):
        _call_signals(
            calls.source[k], (calls.blocks.ctypes.data + _REAL * calls.source_block[k], t)
        )


@inlined
def _signals(calls: Calls, fixed: Fixed, t: float, h: float, u: np.ndarray) -> None:
    """Write the signals at the nodes of a step from t [s] on, and the last channel."""
    count, signals = fixed.nodes.size, calls.signal.size
    first = u.size - count * (signals + 1)
    for i in range(count):
        call_sources(calls, t + h * fixed.nodes[i])
        for k in range(signals):
            u[first + k * count + i] = calls.blocks[calls.signal[k]]
        u[u.size - count + i] = fixed.one


@inlined
def _predict(
    fixed: Fixed, values: int, rung: int, last: int, u: np.ndarray, ahead: np.ndarray
) -> None:
    """Write the laws' inputs of the next step: those of the last one, continued or (-1) held."""
    count = fixed.nodes.size
    for value in range(values):
        at = value * count
        end = u[at + count - 1]
        ahead[at] = end
        for i in range(1, count):
            if last < 0:
                ahead[at + i] = end
                continue
            total = 0.0
            row = fixed.ahead[rung - last + len(fixed.ahead) // 2, i]
            for n in range(count):
                total += row[n] * u[at + n]
            ahead[at + i] = total


@inlined
def _solve_step(
    calls: Calls,
    rungs: Rungs,
    table: Table,
    nodes: Nodes,
    state: State,
    u: np.ndarray,
    room: np.ndarray,
    rung: int,
    matrix: np.ndarray,
    r: np.ndarray,
) -> bool:
    """Find the laws' inputs of a step from those in `u`; False if the iteration does not end.

    Args:
        calls, rungs, table, nodes, state: of the march.
        u: inputs of the step.
        room: arguments at all nodes, of the coordinates and the angles at the start.
        rung: of the step.
        matrix, r: room for the iteration.
    """
    inner = len(nodes.z)
    z = nodes.z.reshape(nodes.z.size)
    for _ in range(MOST_ITERATIONS):
        copy(room, z)
        add_inputs(rungs.of_inputs[rung], u, 0, z)
        for i in range(inner):
            _call_laws(calls, nodes.z[i], nodes.f[i], nodes.k[i], nodes.e[i + 1])
        state.counted[EVALUATIONS] += 1
        residual = residuals(table, nodes, u, r)
        iteration_matrix(table, nodes, rungs.along[rung], matrix)
        solve(matrix, r)
        for value in range(table.unknown.size):
            row = table.unknown[value]
            if row >= 0:
                for i in range(inner):
                    u[value * (inner + 1) + i + 1] += r[row * inner + i]
        if residual <= _CLOSE:
            return True
    return False


@inlined
def _keep(
    samples: Samples, n: int, state: State, u: np.ndarray, t: float, h: float, end: float
) -> int:
    """Keep the step from t on for all times up to its end, from the n-th on; returns the next."""
    while n < samples.times.size and samples.times[n] < end:
        copy(state.x, samples.x[n])
        copy(state.y, samples.y[n])
        copy(state.angle, samples.angle[n])
        copy(u, samples.u[n])
        samples.since[n], samples.length[n] = max(0.0, samples.times[n] - t), h
        n += 1
    return n


@kernel
def begin(calls: Calls, table: Table, nodes: Nodes, u: np.ndarray) -> None:
    """Write the laws' inputs at the end of a step in `u`, and their indicators at the start.

    From the arguments, which stand in `nodes.z[0]`.
    """
    count = len(nodes.e)
    _call_laws(calls, nodes.z[0], nodes.f[0], nodes.k[0], nodes.e[0])
    for value in range(table.unknown.size):
        rest = nodes.f[0, value]
        for j in range(len(nodes.z[0])):
            rest -= table.tangent[value, j] * nodes.z[0, j]
        u[value * count + count - 1] = rest


@inlined
def _advance(rungs: Rungs, rung: int, u: np.ndarray, state: State) -> None:
    add_rows(rungs.angle[0, rung], rungs.angle[1, rung], state.x, state.y, state.angle)
    add_inputs(rungs.angle_of_inputs[rung], u, 0, state.angle)
    turn(rungs.turn[0, rung], rungs.turn[1, rung], state.x, state.y)
    add_inputs(rungs.push[0, rung], u, 0, state.x)
    add_inputs(rungs.push[1, rung], u, 0, state.y)
    copy(u, state.u)


@allocating
def march(
    calls: Calls,
    fixed: Fixed,
    rungs: Rungs,
    table: Table,
    nodes: Nodes,
    state: State,
    samples: Samples,
    t0: float,
    steps: int,
) -> int:
    """Take base steps until all of them are taken, or every time that is wanted is passed.

    Where a law bends inside a step, or its iteration does not end, the step is halved, down to the
    last rung; there it is taken with the bend inside.

    Args:
        calls, fixed, rungs, table, nodes: of the system.
        state: where it stands; changed.
        samples: filled from the first on.
        t0: start of base step 0 [s].
        steps: base steps in all.

    Returns:
        A status; after NOT_CONVERGED or NOT_FINITE, `state` is at the start of the step.
    """
    last = rungs.lengths.size - 1
    shortest, per_step = rungs.lengths[last], 1 << last
    u, room = np.zeros_like(state.u), np.zeros(nodes.z.size)
    unknowns = rungs.along.shape[3]
    matrix, r = np.empty((unknowns, unknowns)), np.empty(unknowns)
    n, place = 0, state.place
    while place[0] < steps:
        rung = place[2]
        t, h = t0 + (place[0] * per_step + place[1]) * shortest, rungs.lengths[rung]
        _signals(calls, fixed, t, h, u)
        _predict(fixed, table.unknown.size, rung, place[3], state.u, u)
        fill(room, 0.0)
        add_rows(rungs.rows[0, rung], rungs.rows[1, rung], state.x, state.y, room)
        arguments = len(fixed.of_angles)
        for node in range(len(nodes.z)):
            for i in range(arguments):
                room[node * arguments + i] += fixed.offset[i]
                for k in range(state.angle.size):
                    room[node * arguments + i] += fixed.of_angles[i, k] * state.angle[k]
        solved = _solve_step(calls, rungs, table, nodes, state, u, room, rung, matrix, r)
        bent = solved and turned(nodes)
        if rung < last and (bent or not solved):
            place[2], place[3] = rung + 1, -1 if not solved else place[3]
            state.counted[HALVINGS] += 1
            continue
        if not solved:
            return NOT_CONVERGED
        state.counted[STEPS] += 1
        size = 1 << (last - rung)
        end = t0 + (place[0] * per_step + place[1] + size) * shortest
        if place[0] == steps - 1 and place[1] + size == per_step:
            end = np.inf
        n = _keep(samples, n, state, u, t, h, end)
        if n == samples.times.size:  # the next one may lie in this step, too
            return DONE
        _advance(rungs, rung, u, state)
        if not np.isfinite(state.x[0] + state.y[0]):
            return NOT_FINITE
        copy(nodes.e[len(nodes.z)], nodes.e[0])
        place[3] = -1 if bent else rung
        place[1] += size
        if place[1] == per_step:
            place[0], place[1] = place[0] + 1, 0
        while place[2] > 0 and place[1] % (1 << (last - place[2] + 1)) == 0:
            place[2] -= 1
    return DONE
