"""A step from node to node of a part that holds its inputs; see `nodal.calls`."""

import numpy as np
from numba import carray

from herringbone.cosim.loops.calls import at_address, exchange_reals, state_call
from herringbone.cosim.loops.calls import do_step as step_part
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.cosim.nodal.held import give, hold
from herringbone.cosim.nodal.once import make_up, remember
from herringbone.cosim.nodal.watch import compare
from herringbone.cosim.signature.rotation import InputRule
from herringbone.kernels.compiling.jit import allocating
from herringbone.kernels.signals import STRIDE, evaluate, monomial

_START = int(InputRule.START)
_BYTES = 8


@allocating
def read(memory: np.ndarray, later: bool) -> int:
    """Outputs of the part, as they are, now or when it has answered; FMI status."""
    part = memory[0]
    if part.outputs == 0:
        return 0
    function = part.get_later if later else part.get_real
    return exchange_reals(function, part.component, part.output_references, part.outputs, part.raw)


@allocating
def expand(memory: np.ndarray) -> None:
    """Coefficients of the input signals."""
    part = memory[0]
    given = carray(at_address(part.given), part.inputs * STRIDE, np.float64)
    coefficients = carray(at_address(part.coefficients), part.inputs * STRIDE, np.float64)
    for i in range(part.inputs):
        monomial(given, i * STRIDE, part.degree, coefficients, i * STRIDE)


@allocating
def _keep(memory: np.ndarray, node: int, end: float, length: float) -> None:
    """Outputs at a node: those of the part, and what passes directly; `length` of the piece [s]."""
    part = memory[0]
    coefficients = carray(at_address(part.coefficients), part.inputs * STRIDE, np.float64)
    driven = carray(at_address(part.driven), part.inputs, np.int64)
    held = carray(at_address(part.held), 2 * part.inputs, np.float64)
    raw = carray(at_address(part.raw), part.outputs, np.float64)
    values = carray(at_address(part.values), part.outputs * STRIDE, np.float64)
    feedthrough = carray(at_address(part.feedthrough), part.outputs * part.inputs, np.float64)
    place = carray(at_address(part.place), part.inputs, np.int64)
    rate = carray(at_address(part.rate), part.inputs, np.int64)
    last = (part.pieces - 1) * part.inputs
    for j in range(part.outputs):
        value = raw[j]
        if part.at_end == 0 and part.degree > 0:
            for i in range(part.inputs):
                passed = feedthrough[j * part.inputs + i]
                if driven[i] and passed != 0.0:
                    at_end = evaluate(coefficients, i * STRIDE, part.degree, end)
                    seen = held[last + i]
                    if place[i] == _START and rate[i] >= 0:
                        seen += length * held[last + rate[i]]
                    value += passed * (at_end - seen)
        values[j * STRIDE + node] = value
        values[j * STRIDE] = value


@allocating
def _at_node(memory: np.ndarray, node: int) -> None:
    """What is held, and what is read, is that of a node now."""
    part = memory[0]
    memory[0].held = part.all_held + _BYTES * 2 * part.inputs * (node - 1)
    memory[0].raw = part.all_raw + _BYTES * part.outputs * (node - 1)


@allocating
def take(memory: np.ndarray, time: float, step: float, later: bool) -> int:
    """Step the part from node to node; FMI status."""
    part = memory[0]
    nodes = max(1, part.degree)
    length = step / (nodes * part.pieces)
    for node in range(1, nodes + 1):
        _at_node(memory, node)
        hold(memory, (node - 1) / nodes, node / nodes, step)
        if part.once:
            make_up(memory, step)
        for piece in range(part.pieces):
            held = memory[0].held + _BYTES * piece * part.inputs
            status = give(memory, carray(at_address(held), part.inputs, np.float64))
            if status > LAST_GOOD:
                return status
            begin = time + ((node - 1) * part.pieces + piece) * length
            status = step_part(part.do_step, part.component, begin, length)
            if status > LAST_GOOD:
                return status
        status = read(memory, later)
        if status > LAST_GOOD:
            return status
    return 0


@allocating
def end(memory: np.ndarray, time: float, step: float) -> None:
    """The outputs of a step are there: signals, and what is remembered."""
    part = memory[0]
    nodes = max(1, part.degree)
    length = step / (nodes * part.pieces)
    for node in range(1, nodes + 1):
        _at_node(memory, node)
        if part.watched:
            compare(memory, node, time, step)
        _keep(memory, node, node / nodes, length)
    memory[0].seen_piece, memory[0].stepped, memory[0].state_time = length, 1, time + step
    if part.once:
        remember(memory, time, step)


@allocating
def settle(memory: np.ndarray) -> int:
    """Wait for the outputs of the last step, if they have not come; FMI status."""
    part = memory[0]
    if part.pending == 0:
        return 0
    memory[0].pending = 0
    status = state_call(part.finish, part.component, 1)
    if status <= LAST_GOOD:
        end(memory, part.pending_time, part.pending_step)
    return status
