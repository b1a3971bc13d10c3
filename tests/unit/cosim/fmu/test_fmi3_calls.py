"""The FMI 2.0 functions in front of FMI 3.0 functions, on functions that note how they are called.

The part has a scalar a (value reference 7), an array b of three (9) and a scalar c (4), so that
the elements are a, b1, b2, b3, c.
"""

import copy
from ctypes import (
    CFUNCTYPE,
    POINTER,
    byref,
    c_bool,
    c_double,
    c_int,
    c_size_t,
    c_uint8,
    c_uint32,
    c_void_p,
    cast,
)

import numpy as np
import pytest

from herringbone.cosim.fmu.fmi3 import calls, memory, steps, within

A, B1, B3, C = 0, 1, 3, 4
SIZES = {7: 1, 9: 3, 4: 1}
OK, DISCARD, ERROR = 0, 2, 3

_REFERENCES, _REALS, _FLAG = POINTER(c_uint32), POINTER(c_double), POINTER(c_bool)
FLOAT64 = CFUNCTYPE(c_int, c_void_p, _REFERENCES, c_size_t, _REALS, c_size_t)
STEP = CFUNCTYPE(c_int, c_void_p, c_double, c_double, c_int, _FLAG, _FLAG, _FLAG, _REALS)
EXCHANGE_2 = CFUNCTYPE(c_int, c_void_p, _REFERENCES, c_size_t, _REALS)
RESTORE = CFUNCTYPE(c_int, c_void_p, c_void_p)
MODE = CFUNCTYPE(c_int, c_void_p)
UPDATE = CFUNCTYPE(c_int, c_void_p, _FLAG, _FLAG, _FLAG, _FLAG, _FLAG, _REALS)
SLOPE = CFUNCTYPE(c_int, c_void_p, POINTER(c_uint32), c_size_t, POINTER(c_int), POINTER(c_double))
BACK = CFUNCTYPE(None, c_void_p, c_double, *[c_uint8] * 4, POINTER(c_uint8), POINTER(c_double))
STEP_2 = CFUNCTYPE(c_int, c_void_p, c_double, c_double, c_int)


class Fmi3:
    """FMI 3.0 functions that keep values by value reference, and the memory of their adapters."""

    def __init__(self):
        self.values = {7: [1.0], 9: [2.0, 3.0, 4.0], 4: [5.0]}
        self.calls, self.steps = [], []
        self.step_results = [(OK, False, False, False)]
        self.share = 0.5
        self.modes, self.updates = [], [(False, False)]
        self.functions = (
            FLOAT64(self.set), FLOAT64(self.get), STEP(self.step), RESTORE(self.restore),
            MODE(lambda _: self.mode("events")), MODE(lambda _: self.mode("steps")),
            UPDATE(self.update),
        )  # fmt: skip
        rows = [(7, 0, 1, 0, 0), *[(9, 1, 3, 0, 0)] * 3, (4, 4, 1, 0, 1)]
        self.arrays = (
            np.array(rows, memory.ELEMENT), np.array([1.0, 2.0, 3.0, 4.0, 5.0]),
            np.zeros(5, np.uint32), np.zeros(5), np.array([B1], np.uint32),
            np.zeros(1), np.zeros(2),
            np.zeros(5, np.uint32), np.zeros(5 * memory.ORDERS), np.zeros(5),
        )  # fmt: skip
        self.reached = self.arrays[5]
        self.asks_at: list[float] = []
        self.held: list[dict] = []
        self.memory = np.zeros(1, memory.MEMORY)
        self.memory["count"], self.memory["instance"], self.memory["array_count"] = 5, 42, 1
        for place, function in zip(
            ("set_float64", "get_float64", "do_step", "set_state", "enter_events", "enter_steps",
             "update"), self.functions, strict=True
        ):  # fmt: skip
            self.memory[place] = cast(function, c_void_p).value
        for place, array in zip(
            ("elements", "values", "references", "packed", "arrays", "reached", "flags",
             "bent_inputs", "slopes", "starts"),
            self.arrays, strict=True,
        ):  # fmt: skip
            self.memory[place] = array.ctypes.data

    def _variables(self, instance, references, count, value_count):
        assert instance == 42
        found = [references[i] for i in range(count)]
        assert value_count == sum(SIZES[r] for r in found)
        self.calls.append(found)
        return found

    def set(self, instance, references, count, values, value_count):
        at = 0
        for r in self._variables(instance, references, count, value_count):
            self.values[r] = [values[at + k] for k in range(SIZES[r])]
            at += SIZES[r]
        return OK

    def get(self, instance, references, count, values, value_count):
        found = self._variables(instance, references, count, value_count)
        for at, value in enumerate(v for r in found for v in self.values[r]):
            values[at] = value
        return OK

    def step(self, instance, time, step, no_set_before, event, terminate, early, reached):
        self.steps.append((instance, time, step, no_set_before))
        self.held.append(copy.deepcopy(self.values))
        for at in self.asks_at:
            early_return, end = c_uint8(170), c_double()  # an FMU may not have set it
            BACK(within.update.address)(
                self.memory.ctypes.data, at, 1, 0, 0, 1, byref(early_return), byref(end)
            )
            assert early_return.value == 0
            self.held.append(copy.deepcopy(self.values))
        assert (event[0], terminate[0], early[0]) == (False, False, False)
        result = self.step_results.pop(0) if len(self.step_results) > 1 else self.step_results[0]
        status, event[0], terminate[0], early[0] = result
        reached[0] = time + (self.share if early[0] else 1.0) * step
        return status

    def mode(self, name):
        self.modes.append(name)
        return OK

    def update(self, instance, more, ends, _nominals, _states, _timed, _time):
        self.modes.append("update")
        more[0], ends[0] = self.updates.pop(0) if len(self.updates) > 1 else self.updates[0]
        return OK

    def restore(self, instance, state):
        assert (instance, state) == (42, 77)
        self.values[9] = [6.0, 7.0, 8.0]
        return OK

    def exchange(self, function, elements, values):
        count = len(elements)
        given = (c_double * count)(*values)
        call = EXCHANGE_2(function.address)
        assert call(self.memory.ctypes.data, (c_uint32 * count)(*elements), count, given) == OK
        return list(given)


def test_scalars_and_arrays_are_set_whole_and_once():
    part = Fmi3()
    part.exchange(calls.set_real, [C, B3, A, B1], [50.0, 40.0, 10.0, 20.0])
    assert part.values == {7: [10.0], 9: [20.0, 3.0, 40.0], 4: [50.0]}
    assert part.calls == [[4, 9, 7]]


def test_elements_are_got_in_the_order_asked_for():
    part = Fmi3()
    part.values = {7: [-1.0], 9: [-2.0, -3.0, -4.0], 4: [-5.0]}
    assert part.exchange(calls.get_real, [B3, C, B1], [0.0] * 3) == [-4.0, -5.0, -2.0]
    assert part.calls == [[9, 4]]
    part.exchange(calls.set_real, [B1], [0.0])
    assert part.values[9] == [0.0, -3.0, -4.0]


def test_array_of_a_restored_state_is_kept_but_for_what_is_set():
    part = Fmi3()
    part.exchange(calls.set_real, [B1], [20.0])
    assert RESTORE(calls.set_state.address)(part.memory.ctypes.data, 77) == OK
    part.exchange(calls.set_real, [B3], [40.0])
    assert part.values[9] == [6.0, 7.0, 40.0]


SLOPES = {(B1, 1): 8.0, (A, 1): 4.0, (A, 2): 32.0}
"""Derivatives by element and order, at the start of a step from 0.5 s to 0.75 s."""


def bend(part):
    """Values and derivatives of two inputs, as the loop gives them."""
    part.exchange(calls.set_real, [A, B1], [10.0, 20.0])
    count = len(SLOPES)
    elements, orders = zip(*SLOPES, strict=True)
    status = SLOPE(within.set_derivatives.address)(
        part.memory.ctypes.data, (c_uint32 * count)(*elements), count, (c_int * count)(*orders),
        (c_double * count)(*SLOPES.values()),
    )  # fmt: skip
    assert status == OK


def test_inputs_follow_their_derivatives_when_they_are_asked_for():
    """10 + 4 s + 16 s^2 and 20 + 8 s at s = 0 and 1/8 s; array elements go with their array."""
    part = Fmi3()
    part.asks_at = [0.5, 0.625]
    bend(part)
    assert step(part) == OK
    assert part.held[1] == {7: [10.0], 9: [20.0, 3.0, 4.0], 4: [5.0]}
    assert part.held[2] == {7: [10.75], 9: [21.0, 3.0, 4.0], 4: [5.0]}
    part.held.clear()
    bend(part)
    step(part)
    assert part.held[0] == {7: [10.0], 9: [20.0, 3.0, 4.0], 4: [5.0]}  # it asks: no means


def test_inputs_that_are_never_asked_for_are_held_at_their_means():
    """Over 1/4 s: 10 + 4 / 8 + 16 / 48 and 20 + 8 / 8; derivatives are good for one step."""
    part = Fmi3()
    bend(part)
    step(part)
    assert part.held[0] == {
        7: [pytest.approx(10.0 + 0.5 + 1.0 / 3.0)],
        9: [21.0, 3.0, 4.0],
        4: [5.0],
    }
    part.exchange(calls.set_real, [A], [1.0])
    step(part)
    assert part.held[1][7] == [1.0]
    assert part.memory["steps_bent"][0] == 1


def step(part):
    return STEP_2(steps.do_step.address)(part.memory.ctypes.data, 0.5, 0.25, 1)


EVENT, TERMINATE, EARLY = (True, False, False), (False, True, False), (False, False, True)
ONWARDS = (OK, False, False, False)


@pytest.mark.parametrize(
    ("result", "status", "ended"),
    [
        (ONWARDS, OK, memory.RUNS),
        ((OK, *TERMINATE), OK, memory.ENDED),
        ((OK, *EARLY), DISCARD, memory.EARLY),
        ((OK, False, True, True), DISCARD, memory.ENDED),
        ((ERROR, *EARLY), ERROR, memory.RUNS),
        ((DISCARD, False, False, False), DISCARD, memory.RUNS),
    ],
)
def test_step_without_event_mode(result, status, ended):
    part = Fmi3()
    part.step_results = [result]
    assert step(part) == status
    assert part.steps == [(42, 0.5, 0.25, 1)]
    assert part.memory["ended"][0] == ended
    assert part.modes == []


def test_after_the_wish_to_end_no_step_follows_but_a_restored_state_runs():
    part = Fmi3()
    part.step_results = [(OK, *TERMINATE)]
    assert [step(part), step(part)] == [OK, DISCARD]
    assert len(part.steps) == 1
    assert part.reached[0] == 0.75
    assert RESTORE(calls.set_state.address)(part.memory.ctypes.data, 77) == OK
    assert step(part) == OK


def test_early_return_for_an_event_is_followed_by_the_rest_of_the_step():
    part = Fmi3()
    part.memory["events"] = 1
    part.step_results = [(OK, True, False, True), (OK, True, False, True), ONWARDS]
    part.updates = [(True, False), (False, False)]
    assert step(part) == OK
    assert [(t, h) for _, t, h, _ in part.steps] == [(0.5, 0.25), (0.625, 0.125), (0.6875, 0.0625)]
    assert part.modes == ["events", "update", "update", "steps", "events", "update", "steps"]


def test_event_at_the_end_of_a_step():
    part = Fmi3()
    part.memory["events"] = 1
    part.step_results = [(OK, *EVENT)]
    part.updates = [(False, True)]
    assert step(part) == OK
    assert part.modes == ["events", "update", "steps"]
    assert part.memory["ended"][0] == memory.ENDED
    assert len(part.steps) == 1


@pytest.mark.parametrize("endless", ["update", "step"])
def test_endless_events_end(endless):
    part = Fmi3()
    part.memory["events"] = 1
    part.step_results = [(OK, True, False, endless == "step")]
    part.share, part.updates = 0.0, [(endless == "update", False)]
    assert step(part) == (ERROR if endless == "update" else DISCARD)
    why = memory.STUCK if endless == "update" else memory.EARLY
    assert part.memory["ended"][0] == why


@pytest.mark.parametrize(("events", "modes"), [(0, []), (1, ["events", "update", "steps"])])
def test_discrete_inputs_are_set_at_events(events, modes):
    part = Fmi3()
    part.memory["events"] = events
    part.exchange(calls.set_real, [A], [10.0])
    assert part.modes == []
    part.exchange(calls.set_real, [A, C], [11.0, 50.0])
    assert part.modes == modes
    assert (part.values[7], part.values[4]) == ([11.0], [50.0])
