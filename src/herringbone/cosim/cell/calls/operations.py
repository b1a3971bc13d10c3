"""Operations that a message is made of: begun, filled, collected, and sent when it is time."""

import numpy as np
from numba import carray

from herringbone.cosim.cell.block import GET, GET_DERIVATIVES, KINDS, READS, STEP
from herringbone.cosim.cell.calls.messages import (
    LAST_GOOD,
    LATER,
    OUTPUTS,
    RATES,
    WORDS,
    land,
    launch,
    send,
)
from herringbone.cosim.loops.calls import at_address
from herringbone.kernels.compiling.jit import allocating


@allocating
def begin(memory: np.ndarray, kind: int, count: int) -> int:
    """Begin an operation: where its content goes, in words."""
    part = memory[0]
    words = carray(at_address(part.words), part.used + 2, np.int64)
    words[part.used], words[part.used + 1] = kind, count
    return part.used + 2


@allocating
def collected(memory: np.ndarray, kind: int) -> int:
    """An operation is complete: it waits, or is sent if it is the first of its kind. FMI status."""
    part = memory[0]
    part.valid = part.rate_valid = 0
    known = carray(at_address(part.known), KINDS, np.uint8)
    if known[kind]:
        return 0
    status = send(memory)
    if status <= LAST_GOOD:
        known[kind] = 1
    return status


@allocating
def _want(memory: np.ndarray, to: int, count: int, what: int) -> None:
    part = memory[0]
    wanted = carray(at_address(part.wanted), WORDS * READS, np.int64)
    at = WORDS * part.reads
    wanted[at], wanted[at + 1], wanted[at + 2] = to, count, what
    memory[0].reads += 1


@allocating
def _get(memory: np.ndarray, references: np.ndarray, count: int) -> None:
    at = begin(memory, GET, count)
    words = carray(at_address(memory[0].words), at + count, np.int64)
    for i in range(count):
        words[at + i] = references[i]
    memory[0].used = at + count


@allocating
def ask_later(memory: np.ndarray, references: np.ndarray, count: int, to: int) -> None:
    """Collect the request for outputs that go to an address."""
    _get(memory, references, count)
    _want(memory, to, count, LATER)


@allocating
def ask(memory: np.ndarray) -> None:
    """Collect the request for the outputs that were read before."""
    part = memory[0]
    _get(memory, carray(at_address(part.references), part.count, np.uint32), part.count)
    _want(memory, part.found, part.count, OUTPUTS)


@allocating
def ask_rates(memory: np.ndarray) -> None:
    """Collect the request for the derivatives that were read last."""
    part = memory[0]
    count = part.rate_count
    at = begin(memory, GET_DERIVATIVES, count)
    words = carray(at_address(part.words), at + 2 * count, np.int64)
    reference = carray(at_address(part.rates), count, np.uint32)
    order = carray(at_address(part.orders), count, np.int32)
    for i in range(count):
        words[at + i], words[at + count + i] = reference[i], order[i]
    part.used = at + 2 * count
    _want(memory, part.rate_found, count, RATES)


@allocating
def launch_step(memory: np.ndarray) -> None:
    """Post the steps that were collected, with the requests for outputs."""
    ask(memory)
    if memory[0].rate_count > 0:
        ask_rates(memory)
    launch(memory)


@allocating
def step_now(memory: np.ndarray) -> int:
    """As `launch_step`, and wait; FMI status."""
    launch_step(memory)
    status = land(memory)
    if status <= LAST_GOOD:
        carray(at_address(memory[0].known), KINDS, np.uint8)[STEP] = 1
    return status
