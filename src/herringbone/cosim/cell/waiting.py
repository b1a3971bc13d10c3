"""Posting a message, and waiting for one: spinning shortly, then asleep, with an eye on the clock.

Spinning is worth while only if the other side answers soon. After some waits in a row that it did
not shorten, it is left out for a while. Messages of a coupling come at even intervals: who waits
naps first and spins when the next one is due. To be woken takes 30 us on a virtual machine, as much
as a step.
"""

import numpy as np
from numba import carray

from herringbone.cosim.cell.atomics import (
    fence,
    load_acquire,
    parent,
    pause,
    sleep_while,
    store_release,
    wake,
)
from herringbone.cosim.cell.block import ALIVE, DIED, LATE, SPIN
from herringbone.cosim.loops.calls import at_address, c_call
from herringbone.kernels.compiling.jit import allocating

_MONOTONIC = 1
_LOOKS = 50
"""At the word between two looks at the clock."""
_VAIN, _REST = 8, 256
"""Waits that spinning did not shorten, and waits without it that follow."""
_SECOND = 1_000_000_000
_SHORTEST, _LONGEST = 1_000, 2_000_000
"""Of naps [ns]; waking up from the shortest one takes some 30 us on a virtual machine."""
_MEMORY = 8
"""Intervals that the mean goes over."""
_clock = c_call("flag", "address")
_poll = c_call("address", "count", "flag")


@allocating
def now(memory: np.ndarray) -> int:
    """Time [ns]."""
    side = memory[0]
    _clock(side.clock, (np.int32(_MONOTONIC), side.now))
    found = carray(at_address(side.now), 2, np.int64)
    return found[0] * _SECOND + found[1]


@allocating
def post(memory: np.ndarray, word: int, value: int, sleeps: int) -> None:
    """Store a counter, and wake who sleeps on it."""
    store_release(word, np.int32(value))
    fence()
    if load_acquire(sleeps) != 0:
        wake(memory[0].syscall, word)


@allocating
def _spun(memory: np.ndarray, word: int, wanted: int) -> bool:
    """True if the counter came while spinning."""
    side = memory[0]
    if load_acquire(word) == wanted:
        return True
    budget = load_acquire(side.block + SPIN)
    if side.rest > 0:
        memory[0].rest -= 1
        return False
    end = now(memory) + budget
    while True:
        for _ in range(_LOOKS):
            if load_acquire(word) == wanted:
                memory[0].misses = 0
                return True
            pause()
        if now(memory) >= end:
            break
    memory[0].misses += 1
    if memory[0].misses >= _VAIN:
        memory[0].misses, memory[0].rest = 0, _REST
    return False


@allocating
def _other_is_gone(memory: np.ndarray) -> bool:
    """True if the cell has ended; for a cell, its master."""
    side = memory[0]
    if side.parent != 0:
        return parent(side.syscall) != side.parent
    return _poll(side.poll, (side.watched, 1, np.int32(0))) > 0


@allocating
def _nap(memory: np.ndarray, word: int, wanted: int, sleeps: int) -> bool:
    """Sleep until the counter is nearly due, where that is known; True if it came meanwhile."""
    side = memory[0]
    time = max(side.interval - side.lead, _SHORTEST)
    soon = side.interval <= load_acquire(side.block + SPIN)
    if soon or time > _LONGEST or side.rest > 0:
        return False
    duration = carray(at_address(side.nap), 2, np.int64)
    duration[0], duration[1] = 0, time
    store_release(sleeps, np.int32(1))
    fence()
    seen = load_acquire(word)
    if seen != wanted:
        sleep_while(side.syscall, word, seen, side.nap)
    store_release(sleeps, np.int32(0))
    return load_acquire(word) == wanted


@allocating
def _learn(memory: np.ndarray, time: int, napped: bool, spun: bool) -> None:
    """The counter came after so long [ns]; what came much later than usual counts as twice that.

    Being up too late costs the other side, so that one nap too long outweighs many good ones.
    """
    side = memory[0]
    usual, budget = side.interval, load_acquire(side.block + SPIN)
    memory[0].interval = usual + (min(time, 2 * usual + budget) - usual) // _MEMORY
    if side.rest > 0:
        return
    if napped:
        memory[0].lead += budget // 4
    else:
        memory[0].lead -= budget // (64 if spun else 16)
    memory[0].lead = min(max(side.lead, budget // 2), side.interval)


@allocating
def await_word(memory: np.ndarray, word: int, wanted: int, sleeps: int) -> int:
    """Wait until a counter has a value; why it did not come, see `block.ALIVE`."""
    if load_acquire(memory[0].block + SPIN) == 0:
        return _slept(memory, word, wanted, sleeps)
    begin, found = now(memory), ALIVE
    napped = _nap(memory, word, wanted, sleeps)
    spun = _spun(memory, word, wanted)
    if not spun:
        found = _slept(memory, word, wanted, sleeps)
    _learn(memory, now(memory) - begin, napped, spun)
    return found


@allocating
def _slept(memory: np.ndarray, word: int, wanted: int, sleeps: int) -> int:
    """Sleep until a counter has a value; why it did not come."""
    side, found = memory[0], ALIVE
    if load_acquire(word) == wanted:
        return ALIVE
    begin = now(memory)
    store_release(sleeps, np.int32(1))
    fence()
    while True:
        seen = load_acquire(word)
        if seen == wanted:
            break
        sleep_while(side.syscall, word, seen, side.timeout)
        if load_acquire(word) == wanted:
            break
        if _other_is_gone(memory):
            found = ALIVE if load_acquire(word) == wanted else DIED
            break
        if side.deadline > 0 and now(memory) - begin > side.deadline:
            found = LATE
            break
    store_release(sleeps, np.int32(0))
    return found
