"""Steps of a condensed core with open inputs, compiled.

A step makes the inputs channels of the core and marches over it. What needs matrices of a length
that is not known yet asks a function of Python for them.
"""

import numpy as np

from herringbone.analysis.twin.condensed.march import (
    BASE,
    DONE,
    HALVINGS,
    INSIDE,
    KEPT,
    LAST,
    NOT_CONVERGED,
    NOT_FINITE,
    RUNG,
    RUNG_WANTED,
    TRIED,
    begin,
    march_in,
)
from herringbone.analysis.twin.condensed.march_arrays import Arrays, Asked
from herringbone.analysis.twin.condensed.step_matrices import HALVINGS as SHORTEST
from herringbone.analysis.twin.core_part.memory import PLACES, readers
from herringbone.cosim.loops.calls import c_call
from herringbone.kernels.compiling.jit import finding
from herringbone.kernels.condensed.modal import copy
from herringbone.kernels.signals import STRIDE, monomial

TIME, MADE_FOR, LAST_LENGTH, BASE_STEP, TRIED_FROM, TRIED_LENGTH = range(6)
"""Of the clock [s]: reached; macro step that there are matrices for; the last one; base step;
begin and length of the step of which the laws' inputs are kept, to begin with when it is repeated;
NaN if there is none."""
DEGREE, MADE_DEGREE, PER_STEP, ENDS_KNOWN, INNER_KNOWN, REST_KNOWN, DIRECT, ASK, STATUS = range(9)
"""Of the flags: degree of the signals; the one that there are matrices for; base steps in a macro
step; 1 where sent outputs at the end, inside, and others are those of the last step; 1 if laws
depend on inputs directly; address of the function of Python; status of the march."""
FOR_STEP, FOR_RUNG, FOR_ROWS = range(3)
"""What is asked for: matrices of a macro step; of a rung; rows at a node and a rung."""
ANSWERED = 1
"""What is returned then; an exception that nobody caught returns 0."""
RUNGS = 1 + SHORTEST
OK, DISCARD = 0, 2

_CALLS, _FIXED, _TABLE = PLACES["calls"], PLACES["fixed"], PLACES["table"]
_NODES, _ROOM, _STATE = PLACES["nodes"], PLACES["room"], PLACES["state"]
_SAMPLES, _RUNGS, _SIGNALS = PLACES["samples"], PLACES["rungs"], PLACES["signals"]
_WORK = PLACES["work"]
_calls_at, _fixed_at, _table_at = readers.calls_at, readers.fixed_at, readers.table_at
_nodes_at, _room_at, _state_at = readers.nodes_at, readers.room_at, readers.state_at
_samples_at, _rungs_at, _work_at = readers.samples_at, readers.rungs_at, readers.work_at
_signals_at = readers.signals_at

ask = c_call("count", "real")


@finding
def _take_inputs(m: np.ndarray, t: float, h: float) -> None:
    """Make the inputs of a step curves over time; see that the laws know where they begin."""
    signals, state, nodes = _signals_at(m, _SIGNALS), _state_at(m, _STATE), _nodes_at(m, _NODES)
    degree, count = signals.flags[DEGREE], signals.last.size
    first, jumped = len(state.curve) - count, False
    for i in range(count):
        monomial(signals.given, i * STRIDE, degree, signals.coefficients, 0)
        curve, per = state.curve[first + i], 1.0
        curve[0] = t
        for j in range(STRIDE):
            curve[1 + j] = signals.coefficients[j] * per
            per /= h
        change = signals.given[i * STRIDE] - signals.last[i]
        if change != 0.0 and signals.flags[DIRECT] != 0:
            jumped = True
            for a in range(nodes.start.size):
                nodes.start[a] += signals.direct[a, i] * change
        signals.last[i] = signals.given[i * STRIDE + degree]
    if jumped:
        copy(nodes.start, nodes.z[0])
        begin(_calls_at(m, _CALLS), _table_at(m, _TABLE), nodes, t, state.u)


@finding
def advance(m: np.ndarray, t: float, h: float) -> int:
    """A macro step from the time t [s] on; FMI status."""
    signals = _signals_at(m, _SIGNALS)
    clock, flags = signals.clock, signals.flags
    if not 0.0 <= h < np.inf:
        return DISCARD
    if h == 0.0:
        return OK
    known = h == clock[MADE_FOR] and flags[DEGREE] == flags[MADE_DEGREE]
    if not known and ask(flags[ASK], (FOR_STEP, h)) != ANSWERED:
        return DISCARD
    _take_inputs(m, t, h)
    state, samples = _state_at(m, _STATE), _samples_at(m, _SAMPLES)
    base, degree = clock[BASE_STEP], flags[DEGREE]
    for k in range(1, degree):
        on_start = (flags[PER_STEP] * k) % degree == 0
        samples.times[k - 1] = t + k * h / degree + (1e-7 * base if on_start else 0.0)
    samples.times[samples.times.size - 1] = np.inf
    place = state.place
    place[BASE], place[INSIDE], place[RUNG], place[KEPT] = 0, 0, 0, 0
    if h != clock[LAST_LENGTH]:
        place[LAST] = -1
    place[TRIED] = t == clock[TRIED_FROM] and h == clock[TRIED_LENGTH]
    halvings = state.counted[HALVINGS]
    status = RUNG_WANTED
    while status == RUNG_WANTED:
        on = Arrays(
            _calls_at(m, _CALLS), _fixed_at(m, _FIXED), _table_at(m, _TABLE), _nodes_at(m, _NODES),
            _room_at(m, _ROOM), state, _work_at(m, _WORK),
        )  # fmt: skip
        status = march_in(on, Asked(_rungs_at(m, _RUNGS), samples, t, flags[PER_STEP]))
        if status == RUNG_WANTED and ask(flags[ASK], (FOR_RUNG, float(place[RUNG]))) != ANSWERED:
            return DISCARD
    flags[STATUS] = status
    clock[TRIED_FROM] = np.nan
    if status != DONE:
        return DISCARD
    clock[TIME], clock[LAST_LENGTH] = t + h, h
    if flags[PER_STEP] == 1 and state.counted[HALVINGS] == halvings:
        clock[TRIED_FROM], clock[TRIED_LENGTH] = t, h
    flags[ENDS_KNOWN], flags[INNER_KNOWN], flags[REST_KNOWN] = 0, 0, 0
    return OK


def why(status: int) -> str:
    """What a status of the march says; "" if nothing went wrong."""
    return {
        NOT_CONVERGED: "the laws of its parts have no solution in the shortest step",
        NOT_FINITE: "a state of its parts is not finite",
    }.get(status, "")
