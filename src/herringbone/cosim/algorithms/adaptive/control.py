"""Step control of an adaptive run that begins: what it measures, and the rung it starts on."""

from collections.abc import Mapping

import numpy as np

from herringbone.cosim.algorithms.iterated import PreparedNodes
from herringbone.cosim.layouts.adaptive import (
    BEFORE,
    BEFORE_THAT,
    ROWS,
    USED,
    WANTED,
    Adaptive,
    new_adaptive,
)
from herringbone.cosim.layouts.inner_stepping import InnerStepping, lengthened
from herringbone.cosim.layouts.measured import measured_signals
from herringbone.cosim.layouts.nodes import Buffers
from herringbone.cosim.loops.adaptive_step.ladder import (
    FIRST,
    FIRST_TOLERANCE,
    RUNGS,
    TICKS,
    dividing_rung,
)
from herringbone.cosim.loops.adaptive_step.step_choice import (
    AIM,
    AIM_BETWEEN_ROWS,
    HELD,
    HELD_BETWEEN_ROWS,
)
from herringbone.cosim.loops.adaptive_step.step_error import ORDER, room_for, update_sizes
from herringbone.cosim.rows.record import Grid

MEMORY = 100.0
"""Time over which forces are taken about a straight line, in largest steps."""
LARGEST_STEP = 2e-4
"""The largest step [s] where nothing is told; shorter ones, for rows between, leave the memory."""


def step_control(
    prepared: PreparedNodes,
    buffers: Buffers,
    grid: Grid,
    *,
    tolerance: float,
    channels: Mapping[str, np.ndarray],
    inner: InnerStepping,
    times: np.ndarray,
) -> Adaptive:
    """Step control that knows the values at the start, which it writes to the buffers' nodes, too.

    Args:
        prepared: the network laid out for passes.
        buffers: with the start in their history.
        grid: in ticks.
        tolerance: relative error that is asked for [1].
        channels: outputs whose errors count, by group, see `channel_outputs`.
        inner: the bodies' own steps.
        times: room for those of the rows [s].
    """
    nodes, between_rows = prepared.nodes, grid.every > 0
    measured = measured_signals(nodes, _held(prepared), list(channels.values()))
    control = new_adaptive(
        nodes,
        np.array(RUNGS, dtype=np.int64),
        measured=measured,
        tolerance=tolerance,
        last=grid.count,
        memory=MEMORY * max(TICKS * grid.step, LARGEST_STEP),
        aim=AIM_BETWEEN_ROWS if between_rows else AIM,
        held=HELD_BETWEEN_ROWS if between_rows else HELD,
        inner=lengthened(prepared.network, inner, grid.step),
        times=times,
        room=room_for(measured.output.size),
    )
    first = _first_rung(nodes.degree, tolerance, grid)
    control.state[[WANTED, USED, ROWS]] = first, first, 1
    control.state[[BEFORE, BEFORE_THAT]] = RUNGS[first]
    buffers.nodes[:] = buffers.history[0]
    update_sizes(nodes, buffers, measured, control.moments, control.covered, control.memory, 0.0)
    return control


def _held(prepared: PreparedNodes) -> np.ndarray:
    """(unknowns,) 1 for those that a body holds over the step."""
    held_by = {
        (c.source, c.output)
        for c in prepared.network.connections
        if prepared.degree[c.target] == 0
        and prepared.input_degree(c.target) < prepared.nodes.degree
        and not prepared.layout.at_end[c.target]
    }
    sources = (prepared.jacobian.owners[i] for i in prepared.nodes.unknown)
    return np.array([source in held_by for source in sources], dtype=np.int64)


def _first_rung(degree: int, tolerance: float, grid: Grid) -> int:
    """About the one that will be used, so that its Jacobian serves."""
    ticks = TICKS * FIRST[degree] * (tolerance / FIRST_TOLERANCE) ** (1.0 / ORDER[degree])
    rung = max(0, int(np.searchsorted(RUNGS, ticks, side="right")) - 1)
    if not grid.every:
        return rung
    return dividing_rung(np.array(RUNGS), rung, min(grid.every, grid.count))
