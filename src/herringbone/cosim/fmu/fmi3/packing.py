"""Values of an FMU 3.0 by elements, exchanged by whole variables; see `calls`."""

import numpy as np
from numba import carray

from herringbone.cosim.fmu.fmi3.memory import ELEMENT
from herringbone.cosim.loops.calls import at_address, c_call
from herringbone.kernels.compiling.jit import allocating

exchange = c_call("address", "address", "count", "address", "count")
"""fmi3SetFloat64 or fmi3GetFloat64."""


@allocating
def pack(memory: np.ndarray, references: np.ndarray, count: int) -> tuple[int, int]:
    """Variables of these elements and their last values, to the current call; how many of each."""
    part = memory[0]
    part.calls += 1
    element = carray(at_address(part.elements), part.count, ELEMENT)
    value = carray(at_address(part.values), part.count, np.float64)
    reference = carray(at_address(part.references), part.count, np.uint32)
    packed = carray(at_address(part.packed), part.count, np.float64)
    variables, total = 0, 0
    for i in range(count):
        first = element[references[i]].first
        if element[first].call != part.calls:
            element[first].call = part.calls
            reference[variables] = element[first].reference
            variables += 1
            for k in range(first, first + element[first].size):
                packed[total] = value[k]
                total += 1
    return variables, total


@allocating
def unpack(memory: np.ndarray, references: np.ndarray, count: int) -> None:
    """Values of the current call, to the elements of the variables in the order of `pack`."""
    part = memory[0]
    element = carray(at_address(part.elements), part.count, ELEMENT)
    value = carray(at_address(part.values), part.count, np.float64)
    packed = carray(at_address(part.packed), part.count, np.float64)
    total = 0
    for i in range(count):
        first = element[references[i]].first
        if element[first].call == part.calls:
            element[first].call = 0
            for k in range(first, first + element[first].size):
                value[k] = packed[total]
                total += 1
