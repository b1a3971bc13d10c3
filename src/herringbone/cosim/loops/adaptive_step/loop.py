"""Compiled loop of linearly implicit coupling with an adaptive macro step.

The step is the largest rung of the ladder whose error (see `step_error`) stays within the
tolerance. A step that errs too much, or that a part discards, is taken back and repeated on a
smaller rung. An unstable step shows as an error before it shows in the result: the fastest motion
grows until the estimate sees it, and the next steps are smaller.
"""

import numpy as np

from herringbone.cosim.energy.loop import is_watched
from herringbone.cosim.energy.nodes import watch_nodes
from herringbone.cosim.layouts.adaptive import (
    ACCEPTED,
    BEFORE,
    BEFORE_THAT,
    CULPRIT,
    MISSED,
    MISSED_NOW,
    NEEDED,
    ROWS,
    TAKEN_BACK,
    USED,
    WANTED,
    Adaptive,
)
from herringbone.cosim.layouts.inner_stepping import ARE, TO_BE, Lengthened
from herringbone.cosim.layouts.layout import Chunk, Layout
from herringbone.cosim.layouts.nodes import Buffers, Control, NodeLayout
from herringbone.cosim.loops.adaptive_step.ladder import dividing_rung, fitting_rung
from herringbone.cosim.loops.adaptive_step.step_choice import (
    TOO_MUCH,
    choose_inner_steps,
    continued,
    inner_steps,
    next_rung,
    too_much,
)
from herringbone.cosim.loops.adaptive_step.step_error import (
    COUPLING,
    INNER_STEPS,
    KNOWN,
    error_so_far,
    step_error,
    update_sizes,
)
from herringbone.cosim.loops.common import (
    DISCARDED,
    DONE,
    LAST_GOOD,
    NOT_FINITE,
    PART_FAILED,
    exchange,
    get_outputs,
    not_finite,
)
from herringbone.cosim.loops.jumps import take_back
from herringbone.cosim.loops.node_pass import begin
from herringbone.cosim.loops.nodes import REFRESH, converge, finish
from herringbone.kernels.compiling.jit import inlined, kernel

STEP_LIMIT = 5
"""Status: the smallest step still errs too much."""
PATIENCE = 100
"""So many smallest steps in a row that err too much end the run. A few do not: at a jump of the
forces, or from rest, where their size is not yet known, no step is small enough."""


@inlined
def _record(
    layout: Layout, adaptive: Adaptive, history: np.ndarray, chunk: Chunk, done: int
) -> int:
    """A row, if it is time for one; -1, or the part whose outputs cannot be read."""
    row, t = adaptive.state[ROWS], chunk.t0 + done * chunk.h
    if chunk.every > 0 and done % chunk.every != 0:
        return -1
    for p in range(layout.component.size):
        if get_outputs(layout, history, p, chunk.records, row) > LAST_GOOD:
            return p
    adaptive.times[row] = t
    adaptive.state[ROWS] += 1
    return -1


@inlined
def _accept(
    nodes: NodeLayout, buffers: Buffers, adaptive: Adaptive, corrections: int, h: float
) -> None:
    """Book a step that was taken."""
    state, rung = adaptive.state, adaptive.state[USED]
    measured, moments, covered = adaptive.measured, adaptive.moments, adaptive.covered
    update_sizes(nodes, buffers, measured, moments, covered, adaptive.memory, h)
    for row in range(adaptive.errors.shape[0]):
        for g in range(adaptive.errors.shape[1]):
            adaptive.errors[row, g] += h * adaptive.squares[row, g]
    adaptive.far[0] = error_so_far(measured, moments, adaptive.errors, covered[0])
    for k in range(nodes.degree + 1):
        for i in range(nodes.unknown.size):
            adaptive.before[k, i] = buffers.nodes[k, nodes.unknown[i]]
    state[BEFORE_THAT], state[BEFORE] = state[BEFORE], adaptive.rungs[rung]
    state[ACCEPTED] += 1
    adaptive.taken[rung] += 1
    adaptive.owed[rung] += max(0, corrections - 1)
    if adaptive.owed[rung] > adaptive.corrections.shape[1]:
        adaptive.ready[rung] = NEEDED


@inlined
def _sized(adaptive: Adaptive) -> bool:
    """True as soon as the sizes of channels are known."""
    return adaptive.covered[0] >= KNOWN * adaptive.memory


@inlined
def _tell_inner_steps(layout: Layout, inner: Lengthened) -> int:
    """Tell the parts their inner steps, if they are others than before; -1, or who refused."""
    if inner.times[TO_BE] == inner.times[ARE]:
        return -1
    inner.times[ARE] = inner.times[TO_BE]
    for k in range(inner.part.size):
        inner.value[0] = inner.times[ARE] * inner.step[k]
        status = exchange(
            layout, inner.part[k], layout.set_real, inner.reference, k, 1, inner.value, 0
        )
        if status > LAST_GOOD:
            return inner.part[k]
    return -1


@inlined
def _try(
    layout: Layout,
    nodes: NodeLayout,
    buffers: Buffers,
    control: Control,
    adaptive: Adaptive,
    t: float,
    h: float,
) -> tuple[int, float]:
    """One macro step on the rung in use: who failed (or -1), and its error."""
    state, rung = adaptive.state, adaptive.state[USED]
    known = state[ACCEPTED] + 1
    buffers.spacing[0] = state[BEFORE] / adaptive.rungs[rung]
    buffers.spacing[1] = state[BEFORE_THAT] / adaptive.rungs[rung]
    buffers.counts[2] = 0
    failed = _tell_inner_steps(layout, adaptive.inner)
    if failed >= 0:
        return failed, np.inf
    failed = begin(layout, nodes, buffers, control.order, known, t, h, False)
    if known > 1:
        continued(nodes, buffers, adaptive.before)
    if failed < 0:
        failed, _ = converge(layout, nodes, buffers, adaptive.corrections[rung], control, t, h)
    if failed >= 0:
        adaptive.error[COUPLING] = np.inf
        return failed, np.inf
    groups = adaptive.measured.members.size if _sized(adaptive) else adaptive.measured.units
    coupling, inner, culprit = step_error(
        nodes, buffers, adaptive.measured, adaptive.moments, adaptive.squares, adaptive.room,
        groups, known, inner_steps(adaptive, rung, nodes.degree, adaptive.inner.times[ARE]),
    )  # fmt: skip
    adaptive.error[COUPLING], adaptive.error[INNER_STEPS], state[CULPRIT] = coupling, inner, culprit
    return -1, np.hypot(coupling, inner)


@inlined
def _complete(
    layout: Layout, nodes: NodeLayout, buffers: Buffers, adaptive: Adaptive, chunk: Chunk,
    done: int, corrections: int, error: float,
) -> tuple[int, int, int]:  # fmt: skip
    """Book and record a step that was taken, and choose the next; result as of `_macro_step`."""
    state, rung = adaptive.state, adaptive.state[USED]
    ticks = adaptive.rungs[rung]
    finish(layout, nodes, buffers)
    culprit = not_finite(layout, buffers.history)
    if culprit >= 0:
        return NOT_FINITE, 0, culprit
    if is_watched(chunk.energy, ticks * chunk.h):
        watch_nodes(chunk.energy, buffers.nodes, buffers.trial, ticks * chunk.h)
    _accept(nodes, buffers, adaptive, corrections, ticks * chunk.h)
    failed = _record(layout, adaptive, buffers.history, chunk, done + ticks)
    if failed >= 0:
        return PART_FAILED, ticks, failed
    wanted = next_rung(adaptive, rung, nodes.degree, _sized(adaptive))
    state[WANTED] = min(wanted, rung) if state[TAKEN_BACK] else wanted
    state[TAKEN_BACK] = 0
    missed = not error <= TOO_MUCH * adaptive.tolerance
    state[MISSED] += missed
    state[MISSED_NOW] = state[MISSED_NOW] + 1 if missed else 0
    return STEP_LIMIT if state[MISSED_NOW] == PATIENCE else DONE, ticks, -1


@inlined
def _equal(adaptive: Adaptive, wanted: int, left: int, chunk: Chunk, done: int) -> int:
    """The rung wanted, or that of the step before: between rows steps get twice as long or stay."""
    used = adaptive.state[USED]
    ticks = adaptive.rungs[used]
    if done % chunk.every == 0 or left % ticks != 0 or adaptive.state[TAKEN_BACK]:
        return wanted
    return used if ticks < adaptive.rungs[wanted] < 2 * ticks else wanted


@inlined
def _macro_step(
    layout: Layout, nodes: NodeLayout, buffers: Buffers, control: Control, adaptive: Adaptive,
    chunk: Chunk, done: int,
) -> tuple[int, int, int]:  # fmt: skip
    """Try a macro step after `done` ticks: status, ticks made (0 if taken back), and who failed."""
    state = adaptive.state
    left, wanted = adaptive.last - done, state[WANTED]
    if chunk.every > 0:
        left = min(left, chunk.every - done % chunk.every)
        wanted = _equal(adaptive, dividing_rung(adaptive.rungs, wanted, left), left, chunk, done)
    rung = fitting_rung(adaptive.rungs, wanted, left)
    state[USED] = rung
    if adaptive.ready[rung] <= NEEDED:
        return REFRESH, 0, -1
    choose_inner_steps(adaptive, rung, nodes.degree, _sized(adaptive))
    before = buffers.counts[1]
    t, h = chunk.t0 + done * chunk.h, adaptive.rungs[rung] * chunk.h
    failed, error = _try(layout, nodes, buffers, control, adaptive, t, h)
    smaller = fitting_rung(adaptive.rungs, max(rung - 1, 0), left) < rung
    if failed >= 0 and not (smaller and buffers.counts[2] == DISCARDED):
        return PART_FAILED, 0, failed
    if smaller and too_much(adaptive, rung, error, nodes.degree):
        failed = take_back(layout, nodes, buffers)
        adaptive.rejected[rung] += 1
        wanted = next_rung(adaptive, rung, nodes.degree, _sized(adaptive))
        state[WANTED], state[TAKEN_BACK] = min(rung - 1, wanted), 1
        return PART_FAILED if failed >= 0 else DONE, 0, failed
    corrections = buffers.counts[1] - before
    return _complete(layout, nodes, buffers, adaptive, chunk, done, corrections, error)


@kernel
def run_adaptive(
    layout: Layout,
    nodes: NodeLayout,
    buffers: Buffers,
    control: Control,
    adaptive: Adaptive,
    chunk: Chunk,
) -> tuple[int, int, int]:
    """Run macro steps up to a time; the result is that of `loops.stages.run_stages`, in ticks.

    Args:
        chunk: in ticks; ends early when the rows are full. `every` is the number of ticks between
            rows, at which steps end; 0: each step ends in a row.

    Status REFRESH asks for the correction of the rung `state[USED]`.
    """
    status, done, culprit = DONE, chunk.start, -1
    end, rows = chunk.start + chunk.count, adaptive.times.size
    while status == DONE and done < end and adaptive.state[ROWS] < rows:
        status, ticks, culprit = _macro_step(layout, nodes, buffers, control, adaptive, chunk, done)
        done += ticks
    return status, done, culprit
