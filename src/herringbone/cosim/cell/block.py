"""The shared memory of a master and a cell, and what each keeps for itself."""

from typing import NamedTuple

import numpy as np

LINE = 64
"""Bytes of a cache line: words that different processes write lie on different lines."""
REQUEST, ANSWER, MASTER_SLEEPS, CELL_SLEEPS, SPIN, HEADER = (LINE * k for k in range(6))
"""Places in the block, in bytes; all but the header are one int32.

    REQUEST, ANSWER              counters of messages, and of answers to them
    MASTER_SLEEPS, CELL_SLEEPS   1 while who waits for the other one sleeps in the kernel
    SPIN                         time to spin before that [ns]; 0: not at all
    HEADER                       of the message, see `HEADER_TYPE`
"""
HEADER_TYPE = np.dtype(
    [
        ("kind", np.int64),
        ("instance", np.int64),
        ("words", np.int64),
        ("status", np.int64),
        ("where", np.int64),
        ("time", np.float64),
        ("values", np.int64),
        ("text", np.int64),
        ("more", np.int64),
    ]
)
"""What a message or its answer is.

    kind       OPERATIONS, CONTROL or MORE
    instance   number of the instance
    words      of the operations
    status     worst FMI status of the operations
    where      operation in which the cell is, SET ... GET_DERIVATIVES; 0: in none
    time       of the last step [s]
    values     number of values in the answer
    text       bytes of text
    more       1 if more text follows
"""
OPERATIONS, CONTROL, MORE = 1, 2, 3
"""Kinds of messages: operations of the compiled loop; text for Python; the rest of an answer."""
SET, GET, STEP, SAVE, RESTORE, FREE, SET_DERIVATIVES, GET_DERIVATIVES = range(1, 9)
"""Operations, and the calls in which a cell may be; 0: in none."""
KINDS = 9
TEXT_BYTES = 1 << 18
_LEAST_WORDS, _SIZED_WORDS = 1 << 15, 1 << 21
"""Room at the least; of an FMU that can get larger arrays. Memory is taken where it is used."""
_WORDS_OF_ONE = 16
STATES = 1024
"""Saved states of an instance at the most."""
READS = 64
"""What one message asks for at the most, as the outputs at a node."""
INSTANCES = 64
"""Instances of a cell at the same time at the most."""
_HEADER_BYTES = 4096


class Places(NamedTuple):
    """Where things lie in a block.

    Attributes:
        words: operations (int64).
        values: of outputs (float64).
        text: bytes.
        size: of the block.
    """

    words: int
    values: int
    text: int
    size: int


def places(words: int) -> Places:
    """Layout of a block with room for so many words of operations, and values."""
    first = _HEADER_BYTES
    return Places(first, first + 8 * words, first + 16 * words, first + 16 * words + TEXT_BYTES)


def room(reals: int, *, sized: bool) -> int:
    """Words for the operations of a sweep.

    Args:
        reals: variables of the FMU.
        sized: it has parameters that set the sizes of arrays.
    """
    return (_SIZED_WORDS if sized else _LEAST_WORDS) + _WORDS_OF_ONE * reals


def fits(reals: int, words: int) -> bool:
    """True if so many words are enough for an FMU with so many variables."""
    return _LEAST_WORDS // 2 + _WORDS_OF_ONE * reals <= words


SIDE = np.dtype(
    [
        (name, np.int64)
        for name in (
            "block", "words", "values", "capacity", "syscall", "clock", "poll", "now", "timeout",
            "watched", "parent", "deadline", "lost", "misses", "rest", "flying",
            "nap", "interval", "lead",
        )
    ]
)  # fmt: skip
"""What one side of a block knows, of the whole cell.

    block, words, values      addresses of the block, its operations and its values
    capacity                  how many words, and values, there is room for
    syscall, clock, poll      addresses of the C functions syscall, clock_gettime and poll
    now, timeout              addresses of a timespec to read the clock into; that limits sleep
    watched                   address of the pollfd by which the master sees the cell end
    parent                    number of the process whose child the cell is
    deadline                  time to wait for an answer [ns]; 0: without end
    lost                      why the cell is lost, ALIVE ... LATE
    misses                    waits in a row that spinning did not shorten
    rest                      waits that do not spin
    flying                    address of the instance whose message is under way; 0: none is
    nap                       address of a timespec to nap for
    interval                  mean time until a message comes [ns]
    lead                      time by which a nap ends earlier than that [ns]
"""
ALIVE, DIED, LATE = 0, 1, 2
"""Why a cell is lost: it ended; it did not answer in time."""
INSTANCE = np.dtype(
    [
        (name, np.int64)
        for name in (
            "side", "number", "words", "used", "known", "slots", "references", "count", "found",
            "valid", "status", "rates", "orders", "rate_count", "rate_found", "rate_valid",
            "rate_status", "waiting", "read", "steps", "steps_read", "batch", "flight", "came",
            "reads", "wanted",
        )
    ]
)  # fmt: skip
"""What the master's adapters know of one instance.

    side                        address of the cell's side
    number                      of the instance
    words, used                 address of the operations that are collected; words of them
    known                       address of marks (uint8) of the kinds that were accepted once
    slots                       address of marks (uint8) of the states that are in use
    references, count, found    of the outputs that were read so far: address of the value
                                references (uint32), number, address of the values
    valid, status               1 while these values are still those of the FMU; FMI status
    rates, orders, rate_count, rate_found, rate_valid, rate_status
                                the same of the derivatives that were read last, and address of
                                their orders (int32)
    waiting                     steps that wait to be sent
    read                        1 if outputs were read since the last step
    steps, steps_read           steps since outputs were read, and between the last two times
    batch                       1 if no step is sent until `calls.signals.finish`
    flight                      1 if a message is under way
    came                        worst status of messages that has not been told
    reads, wanted               what the message asks for, and address of where that goes (int64),
                                see `messages`
"""
FUNCTIONS = np.dtype(
    [
        (name, np.int64)
        for name in (
            "component", "set_real", "get_real", "do_step", "get_state", "set_state", "free_state",
            "set_derivatives", "get_derivatives", "states",
        )
    ]
)  # fmt: skip
"""Of one instance: `Addresses`, and the address of its states (int64)."""
SERVER = np.dtype([(name, np.int64) for name in ("side", "instances", "references", "orders")])
"""Addresses of the side, of the instances' functions, and of room for value references (uint32) and
orders (int32)."""
