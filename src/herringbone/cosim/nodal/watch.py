r"""Watch over the direct feedthrough D, which dead zones, clutches and hardening laws change.

A repeated step gives pairs: the same start, other inputs. At each node

    delta y = D delta u_held + what states make of delta u,

the latter in k pieces at most k^2 times as much as in one. Where the rest exceeds a tenth of what D
explains, and what states may explain, D is measured anew before the next step: trial steps of the
last piece's length l / 2^k from the saved state, with each input changed, extrapolated to zero as
in `cosim.signature.feedthrough.response`. It stays the same during a step, so that a repeated step
repeats. What states make of an input is measured with it.
"""

import math

import numpy as np
from numba import carray

from herringbone.cosim.loops.calls import at_address, do_step, exchange_reals, state_call
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.cosim.nodal.held import give
from herringbone.kernels.compiling.jit import allocating
from herringbone.kernels.signals import STRIDE, evaluate

OFF = 0.1
"""Share of a response that D need not explain."""
_HALVINGS = 4
_SMALLEST = 2.0**-10
"""The smallest change of an input over the largest one."""
_ROUNDING = 1e4 * float(np.finfo(float).eps)
_SURE, _NONE = 0.02, 0.01
_RESTING = 8
"""Steps without a measurement, after one that found what was known."""


@allocating
def compare(memory: np.ndarray, node: int, time: float, step: float) -> None:
    """Compare a step at a node with the one from the same start before; note this one."""
    part = memory[0]
    n, m = part.inputs, part.outputs
    held = carray(at_address(part.held), 2 * n, np.float64)
    raw = carray(at_address(part.raw), m, np.float64)
    seen_held = carray(at_address(part.seen_held), 2 * n * STRIDE, np.float64)
    seen_raw = carray(at_address(part.seen_raw), m * STRIDE, np.float64)
    feedthrough = carray(at_address(part.feedthrough), m * n, np.float64)
    answer = carray(at_address(part.answer), m * n, np.float64)
    last, before, below = (part.pieces - 1) * n, 2 * n * node, m * node
    steps = float(node * part.pieces)
    for j in range(m if part.seen_time == time and part.seen_step == step else 0):
        rest, allowed = raw[j] - seen_raw[below + j], _ROUNDING * abs(raw[j])
        for i in range(n):
            known = feedthrough[j * n + i]
            first = held[i] - seen_held[before + i]
            final = held[last + i] - seen_held[before + last + i]
            rest -= known * final
            by_states = abs(answer[j * n + i]) * max(abs(first), abs(final))
            allowed += OFF * abs(known * final) + steps * steps * by_states
            allowed += _ROUNDING * abs(known * held[last + i])
        if abs(rest) > allowed:
            memory[0].suspected = 1
    for k in range(2 * n):
        seen_held[before + k] = held[k]
    for j in range(m):
        seen_raw[below + j] = raw[j]
    if node >= part.degree:
        memory[0].seen_time, memory[0].seen_step = time, step


@allocating
def measure_if_suspected(memory: np.ndarray) -> int:
    """Measure D at the present state, if a step before has shown that it may be another one.

    FMI status: bad if the part does not come back to that state.
    """
    part = memory[0]
    memory[0].resting = max(0, part.resting - 1)
    ended = part.state_time == part.seen_time + part.seen_step
    if part.watched == 0 or part.suspected == 0 or part.resting > 0 or not ended:
        return 0
    memory[0].suspected = 0
    status = state_call(part.get_state, part.component, part.trial_state)
    handle = carray(at_address(part.trial_state), 1, np.int64)
    changed = False
    if status > LAST_GOOD:
        memory[0].watched = 0
        return 0
    for i in range(part.inputs):
        driven = carray(at_address(part.driven), part.inputs, np.int64)
        if driven[i] == 0:
            continue
        if _responses(memory, handle[0], i) > LAST_GOOD:
            memory[0].watched = 0  # it refuses such steps: what was known stays
            break
        changed |= _update(memory, i)
    back = state_call(part.set_state, part.component, handle[0])
    state_call(part.free_state, part.component, part.trial_state)
    memory[0].resting = 0 if changed else _RESTING
    return back


@allocating
def _responses(memory: np.ndarray, state: int, number: int) -> int:
    """Outputs over the change of an input after steps of l / 2^k; FMI status."""
    part = memory[0]
    m = part.outputs
    raw = carray(at_address(part.raw), m, np.float64)
    found = carray(at_address(part.responses), (_HALVINGS + 1) * m, np.float64)
    change = _change(memory, number)
    for j in range(m):
        found[_HALVINGS * m + j] = 0.0
    for k in range(_HALVINGS):
        for changed in range(2):
            status = state_call(part.set_state, part.component, state)
            status = max(status, _give_end(memory, number, change * changed))
            if status <= LAST_GOOD:
                length = part.seen_piece / 2.0**k
                status = do_step(part.do_step, part.component, part.state_time, length)
            if status <= LAST_GOOD:
                status = exchange_reals(
                    part.get_real, part.component, part.output_references, m, part.raw
                )
            if status > LAST_GOOD:
                return status
            for j in range(m):
                if changed == 0:
                    found[k * m + j] = raw[j]
                else:
                    found[k * m + j] = (raw[j] - found[k * m + j]) / change
                size = _ROUNDING * abs(raw[j] / change)
                found[_HALVINGS * m + j] = max(found[_HALVINGS * m + j], size)
    return 0


@allocating
def _change(memory: np.ndarray, number: int) -> float:
    """Change of an input in a trial: a tenth of what the last step changed it by, onward."""
    part = memory[0]
    coefficients = carray(at_address(part.coefficients), part.inputs * STRIDE, np.float64)
    largest = carray(at_address(part.changes), part.inputs, np.float64)[number]
    at = number * STRIDE
    moved = 0.1 * (evaluate(coefficients, at, part.degree, 1.0) - coefficients[at])
    return math.copysign(min(max(abs(moved), _SMALLEST * largest), largest), moved)


@allocating
def _give_end(memory: np.ndarray, number: int, change: float) -> int:
    """Set the inputs to their values at the end of the last step, one of them changed; status."""
    part = memory[0]
    coefficients = carray(at_address(part.coefficients), part.inputs * STRIDE, np.float64)
    packed = carray(at_address(part.packed), part.inputs, np.float64)
    for i in range(part.inputs):
        packed[i] = evaluate(coefficients, i * STRIDE, part.degree, 1.0)
    packed[number] += change
    return give(memory, packed)


@allocating
def _update(memory: np.ndarray, number: int) -> bool:
    """Take over D of an input where the responses tell it; True if it is another one."""
    part = memory[0]
    n, m = part.inputs, part.outputs
    found = carray(at_address(part.responses), (_HALVINGS + 1) * m, np.float64)
    feedthrough = carray(at_address(part.feedthrough), m * n, np.float64)
    answer = carray(at_address(part.answer), m * n, np.float64)
    changed = False
    for j in range(m):
        long, half = found[j], found[m + j]
        quarter, short = found[2 * m + j], found[3 * m + j]
        floor = found[_HALVINGS * m + j]
        first, second, third = 2.0 * half - long, 2.0 * quarter - half, 2.0 * short - quarter
        before, last = (4.0 * second - first) / 3.0, (4.0 * third - second) / 3.0
        largest = max(abs(long), abs(half), abs(quarter), abs(short), floor)
        gone = abs(short) <= max(_SURE * largest, floor)
        seen = max(abs(long), abs(half), abs(quarter), abs(short))
        known = feedthrough[j * n + number]
        lost = seen <= floor and floor > _NONE * max(abs(known), seen)
        if lost or (abs(last - before) > _SURE * largest and not gone):
            continue
        new = 0.0 if gone or abs(last) <= max(_NONE * largest, floor) else last
        changed |= abs(new - known) > OFF * max(abs(new), abs(known))
        feedthrough[j * n + number] = new
        answer[j * n + number] = abs(long - new)
    return changed
