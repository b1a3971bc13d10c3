r"""Values that a part holds in the pieces of a segment, the way from a node to the next.

One piece holds the mean of the signal. Two pieces hold values that keep the moments 0 and 1 of the
signal over the segment: about its middle, with a half width w, u = a0 + a1 s + a2 s^2 + ... gives

    even = a0 + a2 w^2 / 3 + a4 w^4 / 5,   odd = 2 (a1 w / 3 + a3 w^3 / 5),   even -+ odd.

A linear part answers with exp(A (h - t)); about the middle its expansion meets the moments of
u - u_held: the first that is left is the third of a linear signal and the second of a quadratic
one, both of h^5, so that the values at nodes are of order 4. With means it is the first moment, of
h^3, so that they are of order 2.

An input with a rate that the part adds to it inside a piece of length l, by r t from its start or
by -r (l - t) to its end, is given as what is left after that, by the same moments. A part without
memory is given what it sees at the end of the piece; one that adds r t has added r l there.
"""

import numpy as np
from numba import carray

from herringbone.cosim.loops.calls import at_address, exchange_reals
from herringbone.cosim.signature.rotation import InputRule
from herringbone.kernels.compiling.jit import allocating
from herringbone.kernels.signals import STRIDE, evaluate

_START, _END = int(InputRule.START), int(InputRule.END)


@allocating
def hold(memory: np.ndarray, begin: float, end: float, step: float) -> None:
    """Values of all inputs in the pieces of the segment from c = begin to end; macro step [s]."""
    part = memory[0]
    count = part.inputs
    coefficients = carray(at_address(part.coefficients), count * STRIDE, np.float64)
    held = carray(at_address(part.held), 2 * count, np.float64)
    order = carray(at_address(part.order), count, np.int64)
    place = carray(at_address(part.place), count, np.int64)
    rate = carray(at_address(part.rate), count, np.int64)
    length = (end - begin) * step / part.pieces
    for k in range(count):
        i = order[k]
        at = i * STRIDE
        if part.at_end:
            value = evaluate(coefficients, at, part.degree, end)
            if rate[i] >= 0 and place[i] == _START:
                value -= length * held[rate[i]]
            held[i] = held[count + i] = value
            continue
        even, odd = _moments(coefficients, at, part.degree, begin, end)
        if rate[i] >= 0 and place[i] == _START:
            even, odd = _without(even, odd, length, held, rate[i], count, part.pieces, 0.0)
        elif rate[i] >= 0 and place[i] == _END:
            even, odd = _without(even, odd, length, held, rate[i], count, part.pieces, 1.0)
        if part.pieces == 1:
            odd = 0.0
        held[i], held[count + i] = even - odd, even + odd


@allocating
def give(memory: np.ndarray, values: np.ndarray) -> int:
    """Set the inputs that are driven to values (inputs,), which may be `packed`; FMI status."""
    part = memory[0]
    driven = carray(at_address(part.driven), part.inputs, np.int64)
    packed = carray(at_address(part.packed), part.inputs, np.float64)
    references = carray(at_address(part.input_references), part.inputs, np.uint32)
    packed_references = carray(at_address(part.packed_references), part.inputs, np.uint32)
    count = 0
    for i in range(part.inputs):
        if driven[i] == 0:
            continue
        packed[count], packed_references[count] = values[i], references[i]
        count += 1
    if count == 0:
        return 0
    return exchange_reals(part.set_real, part.component, part.packed_references, count, part.packed)


@allocating
def _moments(
    coefficients: np.ndarray, at: int, degree: int, begin: float, end: float
) -> tuple[float, float]:
    """Even and odd part of the held values: by powers of the distance from the middle."""
    middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
    even, slope, curve, third, fourth = coefficients[at + degree], 0.0, 0.0, 0.0, 0.0
    for j in range(degree - 1, -1, -1):
        fourth = fourth * middle + third
        third = third * middle + curve
        curve = curve * middle + slope
        slope = slope * middle + even
        even = even * middle + coefficients[at + j]
    square = half * half
    even += square * (curve / 3.0 + square * fourth / 5.0)
    return even, 2.0 * half * (slope / 3.0 + square * third / 5.0)


@allocating
def _without(
    even: float,
    odd: float,
    length: float,
    held: np.ndarray,
    rate: int,
    count: int,
    pieces: int,
    back: float,
) -> tuple[float, float]:
    """What is left of a signal after its rate's part; back is 1 if that ends at the value."""
    first, last = held[rate], held[count + rate]
    if pieces == 1:
        return even + (back - 0.5) * length * first, 0.0
    even += (0.5 * back - 0.25) * length * (first + last)
    odd -= length * ((0.5 * back - 1.0 / 6.0) * first + (1.0 / 3.0 - 0.5 * back) * last)
    return even, odd
