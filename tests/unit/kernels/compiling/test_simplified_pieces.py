"""Pieces are made shorter once, not by each of their callers."""

import numpy as np
import pytest
from numba import types

from herringbone.kernels.compiling import pieces
from herringbone.kernels.compiling.jit import inner, outside

REALS = types.float64[::1]


def made(decorate):
    """A kernel that nothing keeps, and the LLVM code of its piece."""

    @decorate("test")
    def summed(b):
        total = 0.0
        for i in range(b.size):
            total += b[i] * b[i]
        return total

    summed.piece.compile((REALS,))
    return summed, summed.piece.overloads[REALS,].library.code


@pytest.fixture
def as_numba_writes_it(monkeypatch):
    """Function: as `made`, without being made shorter."""

    def found(decorate):
        with monkeypatch.context() as patch:
            patch.setattr(pieces, "simplify", lambda function: None)
            return made(decorate)

    return found


def instructions(code):
    return sum(len(list(block.instructions)) for f in code.functions for block in f.blocks)


def test_most_of_what_numba_writes_is_gone(as_numba_writes_it):
    """Each variable is read from memory and written to it, and each array unpacked."""
    (_, short), (_, long) = made(inner), as_numba_writes_it(inner)
    assert instructions(short) < instructions(long) / 3


def test_what_stays_outside_of_its_callers_still_does():
    _, code = made(outside)
    (function,) = [f for f in code.functions if not f.is_declaration]
    assert any(b"noinline" in attribute for attribute in function.attributes)


def test_it_computes_the_same_bits(as_numba_writes_it):
    values, expected = np.random.default_rng(5).normal(size=37), 0.0
    for value in values:
        expected += value * value
    for summed, _ in (made(inner), as_numba_writes_it(inner)):

        @inner("test")
        def caller(b, summed=summed):
            return summed(b)

        assert caller(values) == expected


def test_a_call_that_falls_away_takes_nothing_from_other_callers():
    """LLVM takes in what is called so far; what came too early was a call of address 0."""

    @inner("test")
    def shared(b):
        return 2.0 * b[0]

    @inner("test")
    def order(signal):
        if signal is None:
            return 0
        return 1

    @inner("test")
    def first(b):
        if order(None) > 0:
            return shared(b)
        return b[1]

    @inner("test")
    def second(b):
        return shared(b) + 1.0

    @inner("test")
    def caller(b):
        return first(b) + second(b)

    assert caller(np.array([3.0, 5.0])) == 12.0
