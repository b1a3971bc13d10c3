"""The compiled march: steps of the condensed core, laws called by their addresses."""

import numpy as np

from herringbone.analysis.twin.condensed.laws import call_laws, call_signals
from herringbone.analysis.twin.condensed.march_arrays import (
    Arrays,
    Asked,
    Calls,
    Fixed,
    Samples,
    State,
    Work,
)
from herringbone.analysis.twin.condensed.products import (
    add_of_inputs,
    add_of_state,
    add_push,
    coordinates,
)
from herringbone.analysis.twin.condensed.rungs import Rungs
from herringbone.kernels.compiling.jit import inlined, kernel
from herringbone.kernels.compiling.views import matrix
from herringbone.kernels.condensed.channels import inputs, predict
from herringbone.kernels.condensed.collocation import (
    Nodes,
    Table,
    less_tangents,
    residuals,
    spread,
    turned,
)
from herringbone.kernels.condensed.correction import correct
from herringbone.kernels.condensed.modal import copy, turn

DONE, NOT_CONVERGED, NOT_FINITE, RUNG_WANTED = 0, 1, 2, 3
"""Status of a march."""
MOST_ITERATIONS = 8
_USUAL = 4
"""Degree of the polynomials in most runs."""
STEPS, HALVINGS, EVALUATIONS, BENDS = 0, 1, 2, 3
"""What is counted; bends: shortest steps in which a law bends."""
BASE, INSIDE, RUNG, LAST, KEPT, TRIED = 0, 1, 2, 3, 4, 5
"""Places of a state, see `State.place`."""


@inlined
def _solve_step(on: Arrays, rungs: Rungs, rung: int, t: float, h: float) -> bool:
    """Find the laws' inputs of a step from those in `on.work.u`; False if that does not end.

    Args:
        on: with rows, in its room, without the laws' inputs.
        rungs, rung: of the step.
        t, h: start and length of the step [s].
    """
    calls, fixed, table, nodes, room, state, work = on
    inner, values = len(nodes.z), table.unknown.size
    channels = table.least.size
    u, v = matrix(work.u, 0, channels, inner + 1), matrix(work.v, 0, channels, inner + 1)
    rows, chosen = work.rows, work.chosen
    z = matrix(nodes.z, 0, 1, nodes.z.size)[0]
    for _ in range(MOST_ITERATIONS):
        copy(work.free, rows)
        given = inputs(fixed.nodes, table.least, u, 0, values, v, chosen)
        add_of_inputs(rungs, rung, work.v, chosen, given, rows)
        if fixed.lean:
            spread(fixed.sharp, nodes, rows)
        else:
            copy(rows[: z.size], z)
        for i in range(inner):
            now = t + h * fixed.nodes[i + 1]
            call_laws(calls, now, nodes.z[i], nodes.f[i], nodes.k[i], nodes.e[i + 1])
        state.counted[EVALUATIONS] += 1
        residual = residuals(table, nodes, u, room.r)
        correct(table, nodes, rungs.along[rung], room)
        for value in range(values):
            row = table.unknown[value]
            if row >= 0:
                own, by = u[value, 1:], room.r[row * inner : (row + 1) * inner]
                for i in range(inner):
                    own[i] += by[i]
        if residual <= fixed.close:
            return True
    return False


@inlined
def _keep(
    samples: Samples, n: int, state: State, u: np.ndarray, t: float, h: float, end: float
) -> int:
    """Keep the step from t on for all times up to its end, from the n-th on; returns the next."""
    size = state.q.size
    while n < samples.times.size and samples.times[n] < end:
        copy(state.q, samples.held[n, :size])
        copy(u, samples.held[n, size:])
        samples.since[n], samples.length[n] = max(0.0, samples.times[n] - t), h
        n += 1
    return n


@kernel
def begin(calls: Calls, table: Table, nodes: Nodes, t: float, u: np.ndarray) -> None:
    """Write the laws' inputs at the end of a step in `u`, and their indicators at the start.

    From the arguments at the time t [s], which stand in `nodes.z[0]`.
    """
    count = len(nodes.e)
    call_laws(calls, t, nodes.z[0], nodes.f[0], nodes.k[0], nodes.e[0])
    for value in range(table.unknown.size):
        u[value * count + count - 1] = less_tangents(table, value, nodes.f[0, value], nodes.z[0])


@inlined
def _advance(fixed: Fixed, table: Table, rungs: Rungs, rung: int, work: Work, state: State) -> None:
    """Write coordinates and inputs at the end of a step that is solved."""
    modes, q, free, chosen = rungs.turn.shape[2], state.q, work.free, work.chosen
    rotations = coordinates(rungs) - 2 * modes
    for k in range(rotations):
        growth = free.size - rotations + k
        q[2 * modes + k] += free[growth] + free[growth - rotations]
    turn(rungs.turn[rung, 0], rungs.turn[rung, 1], q)
    channels, nodes = table.least.size, fixed.nodes.size
    u, v = matrix(work.u, 0, channels, nodes), matrix(work.v, 0, channels, nodes)
    count = inputs(fixed.nodes, table.least, u, 0, channels, v, chosen)
    add_push(rungs, rung, work.v, chosen, count, q)
    copy(work.u, state.u)


@inlined
def march_in(on: Arrays, asked: Asked) -> int:
    """Take base steps until all of them are taken, or every time that is wanted is passed.

    Where a law bends inside a step, or its iteration does not end, the step is halved, down to the
    last rung; there it is taken with the bend inside.

    Args:
        on: of the system; where its state stands is changed.
        asked: the samples are filled from the place on that stands in the state.

    Returns:
        A status; but after DONE, `state` is at the start of the step. After RUNG_WANTED, go on when
        the rung at which it stands is made.
    """
    if len(on.nodes.z) == _USUAL:
        return _march(_of_degree(_USUAL, on), asked)
    return _march(on, asked)


@inlined
def _of_degree(degree: int, on: Arrays) -> Arrays:
    """The same arrays. Loops over the nodes of a step get short where the compiler knows them."""
    fixed, nodes, count = on.fixed, on.nodes, degree + 1
    known = Fixed(
        fixed.offset,
        fixed.ahead,
        matrix(fixed.nodes, 0, 1, count)[0],
        fixed.one,
        fixed.close,
        fixed.lean,
        fixed.sharp,
        matrix(fixed.between, 0, degree, count),
    )
    own = Nodes(
        matrix(nodes.z, 0, degree, nodes.z.shape[1]),
        matrix(nodes.f, 0, degree, nodes.f.shape[1]),
        matrix(nodes.k, 0, degree, nodes.k.shape[1]),
        matrix(nodes.e, 0, count, nodes.e.shape[1]),
        nodes.start,
    )
    return Arrays(on.calls, known, on.table, own, on.room, on.state, on.work)


@inlined
def _march(on: Arrays, asked: Asked) -> int:
    calls, fixed, table, nodes, _room, state, work = on
    rungs, samples, t0, steps = asked
    last = rungs.lengths.size - 1
    shortest, per_step = rungs.lengths[last], 1 << last
    count, values, place = len(nodes.e), table.unknown.size, state.place
    free, channels = work.free, table.least.size
    u, v = matrix(work.u, 0, channels, count), matrix(work.v, 0, channels, count)
    before = matrix(state.u, 0, channels, count)
    while place[BASE] < steps:
        rung = place[RUNG]
        if not rungs.made[rung]:
            return RUNG_WANTED
        t, h = t0 + (place[BASE] * per_step + place[INSIDE]) * shortest, rungs.lengths[rung]
        call_signals(calls, fixed, state, t, h, u)
        if place[TRIED] == 1:
            place[TRIED] = 0
            for value in range(values):
                u[value, 0] = before[value, count - 1]
        else:
            follows, apart = place[LAST] >= 0, len(fixed.ahead) // 2
            first = (apart + (rung - place[LAST]) * follows) * count * count
            predict(matrix(fixed.ahead, first, count, count), follows, values, before, u)
        copy(fixed.offset, free)
        add_of_state(rungs, rung, state.q[: coordinates(rungs)], free)
        given = inputs(fixed.nodes, table.least, u, values, channels, v, work.chosen)
        add_of_inputs(rungs, rung, work.v, work.chosen, given, free)
        solved = _solve_step(on, rungs, rung, t, h)
        bent = solved and turned(nodes, fixed.between)
        if rung < last and (bent or not solved):
            place[RUNG], place[LAST] = rung + 1, -1 if not solved else place[LAST]
            state.counted[HALVINGS] += 1
            continue
        if not solved:
            return NOT_CONVERGED
        state.counted[STEPS] += 1
        state.counted[BENDS] += bent
        size = 1 << (last - rung)
        end = t0 + (place[BASE] * per_step + place[INSIDE] + size) * shortest
        if place[BASE] == steps - 1 and place[INSIDE] + size == per_step:
            end = np.inf
        place[KEPT] = _keep(samples, place[KEPT], state, work.u, t, h, end)
        if place[KEPT] == samples.times.size:  # the next one may lie in this step, too
            return DONE
        _advance(fixed, table, rungs, rung, work, state)
        if not np.isfinite(state.q[0]):
            return NOT_FINITE
        copy(nodes.e[count - 1], nodes.e[0])
        copy(nodes.z[count - 2], nodes.start)
        place[LAST] = -1 if bent else rung
        place[INSIDE] += size
        if place[INSIDE] == per_step:
            place[BASE], place[INSIDE] = place[BASE] + 1, 0
        while place[RUNG] > 0 and place[INSIDE] % (1 << (last - place[RUNG] + 1)) == 0:
            place[RUNG] -= 1
    return DONE


@kernel
def march(on: Arrays, asked: Asked) -> int:
    """As `march_in`, called from Python."""
    return march_in(on, asked)
