"""Messages of operations, as the master sends them: collected, posted, and answered later.

What is read comes with the answer, in the order in which it was asked for. A message may be under
way while the master does something else; whoever wants to send the next one, or to know what came
of it, waits for it first (`land`).
"""

import numpy as np
from numba import carray, from_dtype, types

from herringbone.cosim.cell.atomics import load_acquire
from herringbone.cosim.cell.block import (
    ALIVE,
    ANSWER,
    CELL_SLEEPS,
    HEADER,
    HEADER_TYPE,
    INSTANCE,
    MASTER_SLEEPS,
    OPERATIONS,
    READS,
    REQUEST,
    SIDE,
)
from herringbone.cosim.cell.waiting import await_word, post
from herringbone.cosim.loops.calls import at_address
from herringbone.kernels.compiling.jit import allocating, c_function

_SIDE = types.CPointer(from_dtype(SIDE))
LAST_GOOD, ERROR, FATAL = 1, 3, 4
"""FMI status."""
OUTPUTS, RATES, LATER = range(3)
"""What is read: the outputs that were read last, their derivatives, or what is asked for later."""
WORDS = 3
"""Of each: address where values go, their number, what it is."""


@allocating
def _post(side: np.ndarray) -> None:
    """Post what stands in the block."""
    block = side[0].block
    number = (load_acquire(block + REQUEST) + 1) & 0x3FFFFFFF
    post(side, block + REQUEST, number, block + CELL_SLEEPS)


@allocating
def _answered(side: np.ndarray) -> int:
    """Wait for the answer to what was posted; why there is none."""
    block = side[0].block
    number = load_acquire(block + REQUEST)
    found = await_word(side, block + ANSWER, number, block + MASTER_SLEEPS)
    if found != ALIVE:
        side[0].lost = found
    return found


@c_function(types.int32(_SIDE))
def converse(memory):  # noqa: ANN001, ANN201
    """Exchange the message that stands in the block; 0, or why there is no answer."""
    side = carray(memory, 1)
    _post(side)
    return types.int32(_answered(side))


@c_function(types.int32(_SIDE))
def land_any(memory):  # noqa: ANN001, ANN201
    """Wait for a message that is under way, whose block is wanted; 0."""
    _land_on(carray(memory, 1))
    return types.int32(0)


@allocating
def _land_on(side: np.ndarray) -> None:
    """Wait for the message that is under way in a cell, if there is one."""
    address = side[0].flying
    if address == 0:
        return
    side[0].flying = 0
    memory = carray(at_address(address), 1, INSTANCE)
    part = memory[0]
    memory[0].flight = 0
    if _answered(side) != ALIVE:
        memory[0].came = FATAL
        return
    header = carray(at_address(side[0].block + HEADER), 1, HEADER_TYPE)
    memory[0].came = max(part.came, header[0].status)
    _deliver(memory, side, header[0].values)


@allocating
def _deliver(memory: np.ndarray, side: np.ndarray, found: int) -> None:
    """Values of an answer go where they were wanted."""
    part = memory[0]
    value = carray(at_address(side[0].values), found + 1, np.float64)
    wanted = carray(at_address(part.wanted), WORDS * READS, np.int64)
    at = 0
    for k in range(part.reads):
        if at >= found:
            break
        to, count, what = wanted[WORDS * k], wanted[WORDS * k + 1], wanted[WORDS * k + 2]
        status = int(value[at])
        into = carray(at_address(to), count, np.float64)
        for i in range(count if status <= LAST_GOOD else 0):
            into[i] = value[at + 1 + i]
        if what == OUTPUTS:
            memory[0].status, memory[0].valid = status, 1
        elif what == RATES:
            memory[0].rate_status, memory[0].rate_valid = status, 1
        else:
            memory[0].came = max(memory[0].came, status)
        at += 1 + count
    memory[0].reads = 0


@allocating
def land(memory: np.ndarray) -> int:
    """Wait for what is under way of this instance; worst FMI status since this was asked last."""
    part = memory[0]
    if part.flight:
        _land_on(carray(at_address(part.side), 1, SIDE))
    status = memory[0].came
    memory[0].came = 0
    return status


@allocating
def launch(memory: np.ndarray) -> None:
    """Post all operations that were collected."""
    part = memory[0]
    side = carray(at_address(part.side), 1, SIDE)
    memory[0].waiting = 0
    _land_on(side)
    if side[0].lost != ALIVE:
        memory[0].used, memory[0].came = 0, FATAL
        return
    own = carray(at_address(part.words), part.used, np.int64)
    words = carray(at_address(side[0].words), part.used, np.int64)
    for i in range(part.used):
        words[i] = own[i]
    header = carray(at_address(side[0].block + HEADER), 1, HEADER_TYPE)
    header[0].kind, header[0].instance = OPERATIONS, part.number
    header[0].words, header[0].status = part.used, 0
    memory[0].used = 0
    memory[0].flight, side[0].flying = 1, memory.ctypes.data
    _post(side)


@allocating
def send(memory: np.ndarray) -> int:
    """Send all operations that were collected, and wait; worst FMI status."""
    launch(memory)
    return land(memory)


@allocating
def room(memory: np.ndarray, words: int) -> int:
    """Wait for what is under way, and make room for an operation; FMI status."""
    part = memory[0]
    status = land(memory)
    if status > LAST_GOOD:
        return status
    side = carray(at_address(part.side), 1, SIDE)
    if part.used + words + 4 > side[0].capacity or part.reads + 2 > READS:
        if words + 4 > side[0].capacity:
            return ERROR
        return send(memory)
    return 0
