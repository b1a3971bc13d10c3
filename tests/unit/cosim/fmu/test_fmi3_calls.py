"""The FMI 2.0 functions in front of FMI 3.0 functions, on functions that note how they are called.

The part has a scalar a (value reference 7), an array b of three (9) and a scalar c (4), so that
the elements are a, b1, b2, b3, c.
"""

from ctypes import CFUNCTYPE, POINTER, c_bool, c_double, c_int, c_size_t, c_uint32, c_void_p, cast

import numpy as np
import pytest

from herringbone.cosim.fmu import fmi3_calls, fmi3_memory, fmi3_steps

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
            np.array(rows, fmi3_memory.ELEMENT), np.array([1.0, 2.0, 3.0, 4.0, 5.0]),
            np.zeros(5, np.uint32), np.zeros(5), np.array([B1], np.uint32),
            np.zeros(1), np.zeros(2),
        )  # fmt: skip
        self.memory = np.zeros(1, fmi3_memory.MEMORY)
        self.memory["count"], self.memory["instance"], self.memory["array_count"] = 5, 42, 1
        for place, function in zip(
            ("set_float64", "get_float64", "do_step", "set_state", "enter_events", "enter_steps",
             "update"), self.functions, strict=True
        ):  # fmt: skip
            self.memory[place] = cast(function, c_void_p).value
        for place, array in zip(
            ("elements", "values", "references", "packed", "arrays", "reached", "flags"),
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
    part.exchange(fmi3_calls.set_real, [C, B3, A, B1], [50.0, 40.0, 10.0, 20.0])
    assert part.values == {7: [10.0], 9: [20.0, 3.0, 40.0], 4: [50.0]}
    assert part.calls == [[4, 9, 7]]


def test_elements_are_got_in_the_order_asked_for():
    part = Fmi3()
    part.values = {7: [-1.0], 9: [-2.0, -3.0, -4.0], 4: [-5.0]}
    assert part.exchange(fmi3_calls.get_real, [B3, C, B1], [0.0] * 3) == [-4.0, -5.0, -2.0]
    assert part.calls == [[9, 4]]
    part.exchange(fmi3_calls.set_real, [B1], [0.0])
    assert part.values[9] == [0.0, -3.0, -4.0]


def test_array_of_a_restored_state_is_kept_but_for_what_is_set():
    part = Fmi3()
    part.exchange(fmi3_calls.set_real, [B1], [20.0])
    assert RESTORE(fmi3_calls.set_state.address)(part.memory.ctypes.data, 77) == OK
    part.exchange(fmi3_calls.set_real, [B3], [40.0])
    assert part.values[9] == [6.0, 7.0, 40.0]


def step(part):
    return STEP_2(fmi3_steps.do_step.address)(part.memory.ctypes.data, 0.5, 0.25, 1)


EVENT, TERMINATE, EARLY = (True, False, False), (False, True, False), (False, False, True)
ONWARDS = (OK, False, False, False)


@pytest.mark.parametrize(
    ("result", "status", "ended"),
    [
        (ONWARDS, OK, fmi3_memory.RUNS),
        ((OK, *TERMINATE), OK, fmi3_memory.ENDED),
        ((OK, *EARLY), DISCARD, fmi3_memory.EARLY),
        ((OK, False, True, True), DISCARD, fmi3_memory.ENDED),
        ((ERROR, *EARLY), ERROR, fmi3_memory.RUNS),
        ((DISCARD, False, False, False), DISCARD, fmi3_memory.RUNS),
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
    assert part.arrays[-2][0] == 0.75
    assert RESTORE(fmi3_calls.set_state.address)(part.memory.ctypes.data, 77) == OK
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
    assert part.memory["ended"][0] == fmi3_memory.ENDED
    assert len(part.steps) == 1


@pytest.mark.parametrize("endless", ["update", "step"])
def test_endless_events_end(endless):
    part = Fmi3()
    part.memory["events"] = 1
    part.step_results = [(OK, True, False, endless == "step")]
    part.share, part.updates = 0.0, [(endless == "update", False)]
    assert step(part) == (ERROR if endless == "update" else DISCARD)
    why = fmi3_memory.STUCK if endless == "update" else fmi3_memory.EARLY
    assert part.memory["ended"][0] == why


@pytest.mark.parametrize(("events", "modes"), [(0, []), (1, ["events", "update", "steps"])])
def test_discrete_inputs_are_set_at_events(events, modes):
    part = Fmi3()
    part.memory["events"] = events
    part.exchange(fmi3_calls.set_real, [A], [10.0])
    assert part.modes == []
    part.exchange(fmi3_calls.set_real, [A, C], [11.0, 50.0])
    assert part.modes == modes
    assert (part.values[7], part.values[4]) == ([11.0], [50.0])
