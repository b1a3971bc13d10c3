"""Pieces of a macro step with signals at nodes, each repeated by itself, to be timed.

They work on what a run has left behind: the signals and saved states of its last macro step.
"""

import numpy as np

from herringbone.cosim.energy.monitor import EnergyMonitor
from herringbone.cosim.energy.nodes import watch_nodes
from herringbone.cosim.layouts.adaptive import Adaptive
from herringbone.cosim.layouts.layout import HISTORY, Layout
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.cosim.loops.adaptive_step.step_error import step_error, update_sizes
from herringbone.cosim.loops.calls import do_step, state_call
from herringbone.cosim.loops.common import get_outputs
from herringbone.cosim.loops.node_pass import get_to_nodes, save_part, set_from_nodes
from herringbone.cosim.loops.nodes import correct, residual
from herringbone.kernels.compiling.jit import kernel

SET, STEP, GET, SAVE, RESTORE = range(5)
"""Calls of a part: inputs at all nodes; a step, after its state was restored; connected outputs at
all nodes; its state."""


@kernel
def call_again(
    layout: Layout, nodes: NodeLayout, buffers: Buffers, p: int, call: int, count: int, t: float,
    h: float,
) -> int:  # fmt: skip
    """Call a part so many times; the worst FMI status."""
    worst = 0
    for _ in range(count):
        if call == SET:
            status = set_from_nodes(layout, buffers, p, h)
        elif call == GET:
            status = get_to_nodes(layout, nodes, buffers, p, h)
        elif call == SAVE:
            status = save_part(layout, nodes, buffers, p)
        else:
            status = state_call(nodes.set_state[p], layout.component[p], buffers.states[p])
            if call == STEP:
                status = max(status, do_step(layout.do_step[p], layout.component[p], t, h))
        worst = max(worst, status)
    return worst


@kernel
def correct_again(buffers: Buffers, correction: np.ndarray, count: int) -> float:
    """Correct the unknowns, and take their residual, so many times."""
    largest = 0.0
    for _ in range(count):
        correct(buffers, correction)
        largest = max(largest, residual(buffers))
    return largest


@kernel
def errors_again(nodes: NodeLayout, buffers: Buffers, adaptive: Adaptive, count: int) -> float:
    """Take the error of a step, and the size of the forces, so many times."""
    total = 0.0
    for _ in range(count):
        coupling, inner, _ = step_error(
            nodes, buffers, adaptive.measured, adaptive.moments, adaptive.squares, adaptive.room,
            adaptive.measured.members.size, HISTORY, 1.0,
        )  # fmt: skip
        update_sizes(
            nodes, buffers, adaptive.measured, adaptive.moments, adaptive.covered, adaptive.memory,
            0.0,
        )  # fmt: skip
        total += coupling + inner
    return total


@kernel
def watch_again(monitor: EnergyMonitor, buffers: Buffers, h: float, count: int) -> None:
    """Account for the energy of a step so many times."""
    for _ in range(count):
        watch_nodes(monitor, buffers.nodes, buffers.trial, h)


@kernel
def record_again(layout: Layout, buffers: Buffers, records: np.ndarray, count: int) -> int:
    """Read all outputs of all parts into the first row so many times; the worst FMI status."""
    worst = 0
    for _ in range(count):
        for p in range(layout.component.size):
            worst = max(worst, get_outputs(layout, buffers.history, p, records, 0))
    return worst
