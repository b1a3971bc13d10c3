"""Derivatives of inputs in units of their own: several orders of each in one call."""

import ctypes
import math

import numpy as np
import pytest

from herringbone.core.part import Addresses, PartVariable
from herringbone.cosim.units.part import SiPart

REAL, WHOLE = ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int)
SET = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.c_void_p, ctypes.POINTER(ctypes.c_uint32), ctypes.c_size_t, WHOLE, REAL
)
RPM = (math.pi / 30.0, 0.0, (("rad", 1), ("s", -1)))
ERROR = 3


class Motor:
    """Takes a speed in r/min and its derivatives, and gives nothing."""

    name, has_states, once, one_step = "motor", True, False, False
    variables = {"n": PartVariable("n", 7, "input", "r/min", RPM)}  # noqa: RUF012 (never changed)

    def __init__(self):
        self.given = []
        self._call = SET(self._set)
        address = ctypes.cast(self._call, ctypes.c_void_p).value
        self.addresses = Addresses(1, 1, 1, 1, set_derivatives=address)

    def _set(self, _, references, count, orders, values):
        self.given = [(references[i], orders[i], values[i]) for i in range(count)]
        return 0


def status(part, count):
    """Of a call that gives orders 1 ... count of the one input."""
    references, orders = np.zeros(count, np.uint32), np.arange(1, count + 1, dtype=np.int32)
    values = np.arange(1.0, count + 1.0)
    function = SET(part.addresses.set_derivatives)
    return function(
        part.addresses.component,
        references.ctypes.data_as(ctypes.POINTER(ctypes.c_uint32)),
        count,
        orders.ctypes.data_as(WHOLE),
        values.ctypes.data_as(REAL),
    )


def test_all_orders_of_an_input_have_room():
    """There are more of them than variables: they stood behind the end of two arrays."""
    motor = Motor()
    part = SiPart(motor)
    assert part._arrays["values"].size >= 4
    assert status(part, 4) == 0
    assert [(r, k) for r, k, _ in motor.given] == [(7, 1), (7, 2), (7, 3), (7, 4)]
    values = [value for _, _, value in motor.given]
    assert values == pytest.approx([k * 30.0 / math.pi for k in (1, 2, 3, 4)], rel=1e-15)


def test_more_than_there_is_room_for_is_refused():
    motor = Motor()
    assert status(SiPart(motor), 5) == ERROR
    assert motor.given == []
