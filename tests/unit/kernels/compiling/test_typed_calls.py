"""Remembered types of calls: numba is asked once, by kernels alone, and the answer is numba's."""

import operator

import numpy as np
import pytest
from numba import float64, int64, types
from numba.core.registry import cpu_target
from numba.extending import overload

from herringbone.kernels.compiling import typed_calls
from herringbone.kernels.compiling.typed_calls import remembered_calls

CONTEXT = cpu_target.typing_context
CALLS = [
    (operator.mul, (float64, float64)),
    (operator.mul, (int64, float64)),
    (operator.getitem, (types.Array(float64, 1, "C"), int64)),
    (operator.lt, (types.literal(2), int64)),
    (np.sqrt, (float64,)),
    (max, (float64, float64)),
]


@pytest.fixture
def asked(monkeypatch):
    """Functions that numba was asked about."""
    found = []

    def ask(function, *args):
        found.append(function.typing_key)
        return typed_calls_ask(function, *args)

    typed_calls_ask = typed_calls._ask
    monkeypatch.setattr(typed_calls, "_ask", ask)
    monkeypatch.setattr(typed_calls, "_found", type(typed_calls._found)())
    yield found
    types.BaseFunction.get_call_type = typed_calls_ask


@pytest.mark.parametrize(("function", "args"), CALLS)
def test_the_answer_is_that_of_numba(asked, function, args):
    CONTEXT.refresh()
    wanted = CONTEXT.resolve_function_type(function, args, {})
    with remembered_calls():
        for _ in range(3):
            assert CONTEXT.resolve_function_type(function, args, {}) == wanted
    assert asked.count(function) == 1


def test_others_are_left_to_numba():
    before = types.BaseFunction.get_call_type
    with remembered_calls():
        with remembered_calls():
            assert types.BaseFunction.get_call_type is not before
        assert types.BaseFunction.get_call_type is not before
    assert types.BaseFunction.get_call_type is before


def test_what_is_registered_later_is_found():
    def late(x):
        raise NotImplementedError

    @overload(late)
    def _first(x):
        return (lambda x: x + 1) if isinstance(x, types.Integer) else None

    with remembered_calls():
        CONTEXT.refresh()
        assert CONTEXT.resolve_function_type(late, (int64,), {}) is not None

        @overload(late)
        def _second(x):
            return (lambda x: 2.0 * x) if isinstance(x, types.Float) else None

        CONTEXT.refresh()
        assert CONTEXT.resolve_function_type(late, (float64,), {}).return_type == float64
