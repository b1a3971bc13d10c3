"""The cell's side of the messages of the compiled loop; FMUs keep modes that they set."""

import numpy as np
from numba import carray, from_dtype, types

from herringbone.cosim.cell.atomics import load_acquire
from herringbone.cosim.cell.block import (
    ALIVE,
    ANSWER,
    CELL_SLEEPS,
    FREE,
    FUNCTIONS,
    GET,
    GET_DERIVATIVES,
    HEADER,
    HEADER_TYPE,
    MASTER_SLEEPS,
    OPERATIONS,
    REQUEST,
    RESTORE,
    SAVE,
    SERVER,
    SET,
    SET_DERIVATIVES,
    SIDE,
    STATES,
    STEP,
)
from herringbone.cosim.cell.waiting import await_word, post
from herringbone.cosim.loops.calls import (
    at_address,
    of_state,
    set_or_get,
    set_or_get_derivatives,
    step_once,
)
from herringbone.kernels.compiling.jit import allocating, c_function

_POINTER = types.CPointer(from_dtype(SERVER))
_LAST_GOOD = 1
_BYTES = 8
_FUNCTIONS_BYTES = FUNCTIONS.itemsize


@allocating
def _listed(server: np.ndarray, first: int, count: int, orders: bool) -> int:
    """References that stand in words from `first`, or orders, as FMI takes them; their address."""
    whole = server[0]
    words = carray(at_address(first), count, np.int64)
    if orders:
        order = carray(at_address(whole.orders), count, np.int32)
        for i in range(count):
            order[i] = words[i]
        return whole.orders
    reference = carray(at_address(whole.references), count, np.uint32)
    for i in range(count):
        reference[i] = words[i]
    return whole.references


@allocating
def _state(part: np.ndarray, kind: int, number: int) -> int:
    """Save, restore or free a state; FMI status."""
    who, handle = part[0], part[0].states + _BYTES * number
    if kind == SAVE:
        return of_state(who.get_state, (who.component, handle))
    saved = carray(at_address(who.states), STATES, np.int64)
    if kind == RESTORE:
        return of_state(who.set_state, (who.component, saved[number]))
    status = of_state(who.free_state, (who.component, handle))
    saved[number] = 0
    return status


@allocating
def _perform(server: np.ndarray, part: np.ndarray, kind: int, count: int, at: int, to: int) -> int:
    """One operation, whose content is at the address `at`; outputs go to `to`. FMI status."""
    who = part[0]
    if kind == STEP:
        given = carray(at_address(at), 2, np.float64)
        return step_once(who.do_step, (who.component, given[0], given[1], np.int32(1)))
    if kind in (SAVE, RESTORE, FREE):
        return _state(part, kind, count)
    references = _listed(server, at, count, False)
    if kind == SET:
        values = at + _BYTES * count
        return set_or_get(who.set_real, (who.component, references, count, values))
    if kind == GET:
        return set_or_get(who.get_real, (who.component, references, count, to))
    orders = _listed(server, at + _BYTES * count, count, True)
    if kind == SET_DERIVATIVES:
        values = at + 2 * _BYTES * count
        return set_or_get_derivatives(
            who.set_derivatives, (who.component, references, count, orders, values)
        )
    return set_or_get_derivatives(
        who.get_derivatives, (who.component, references, count, orders, to)
    )


@allocating
def _length(kind: int, count: int) -> int:
    """Words of an operation's content."""
    if kind in (SAVE, RESTORE, FREE):
        return 0
    if kind in (STEP, GET):
        return count
    return 3 * count if kind == SET_DERIVATIVES else 2 * count


@allocating
def _serve(server: np.ndarray) -> None:
    """All operations of a message, up to the first that fails; what is read has its own status."""
    side = carray(at_address(server[0].side), 1, SIDE)
    header = carray(at_address(side[0].block + HEADER), 1, HEADER_TYPE)
    part = carray(
        at_address(server[0].instances + header[0].instance * _FUNCTIONS_BYTES), 1, FUNCTIONS
    )
    words = carray(at_address(side[0].words), header[0].words, np.int64)
    values = carray(at_address(side[0].values), side[0].capacity, np.float64)
    at, found, worst = 0, 0, 0
    while at < header[0].words and worst <= _LAST_GOOD:
        kind, count = words[at], words[at + 1]
        start = side[0].words + _BYTES * (at + 2)
        header[0].where = kind
        if kind == STEP:
            header[0].time = carray(at_address(start), 1, np.float64)[0]
        to = side[0].values + _BYTES * (found + 1)
        reads = kind in (GET, GET_DERIVATIVES)
        status = 0
        if not (kind == GET and count == 0):
            status = _perform(server, part, kind, count, start, to)
        if reads:
            values[found] = status
            found += 1 + count
        else:
            worst = max(worst, status)
        at += 2 + _length(kind, count)
    header[0].where, header[0].status, header[0].values = 0, worst, found


@c_function(types.int32(_POINTER))
def serve(memory):  # noqa: ANN001, ANN201
    """Answer messages of operations until another one comes, which Python answers; 1: no master."""
    server = carray(memory, 1)
    side = carray(at_address(server[0].side), 1, SIDE)
    block = side[0].block
    header = carray(at_address(block + HEADER), 1, HEADER_TYPE)
    while True:
        number = (load_acquire(block + ANSWER) + 1) & 0x3FFFFFFF
        if await_word(side, block + REQUEST, number, block + CELL_SLEEPS) != ALIVE:
            return types.int32(1)
        if header[0].kind != OPERATIONS:
            return types.int32(0)
        _serve(server)
        post(side, block + ANSWER, number, block + MASTER_SLEEPS)


@c_function(types.int32(_POINTER))
def answer(memory):  # noqa: ANN001, ANN201
    """Say that the answer of Python stands in the block."""
    side = carray(at_address(carray(memory, 1)[0].side), 1, SIDE)
    block = side[0].block
    number = (load_acquire(block + ANSWER) + 1) & 0x3FFFFFFF
    post(side, block + ANSWER, number, block + MASTER_SLEEPS)
    return types.int32(0)
