"""A part that cannot repeat a step: it takes each one once, and a surrogate answers corrections.

It steps on the inputs of the first pass, which are predicted. In later passes over the same step
its outputs at the nodes are those of that step and what D makes of the change of the inputs,

    y_k = y_k(first pass) + D (u_k - u_k(first pass)),

so that what passes directly is solved with the other parts. What the states missed, the mean of the
change, is held in addition in the step that follows: the defect of a step acts one step late, and
does not add up.
"""

import numpy as np
from numba import carray

from herringbone.cosim.loops.calls import at_address
from herringbone.kernels.compiling.jit import allocating
from herringbone.kernels.signals import STRIDE, monomial


@allocating
def remember(memory: np.ndarray, time: float, step: float) -> None:
    """Keep inputs and outputs of a step that was taken."""
    part = memory[0]
    given = carray(at_address(part.given), part.inputs * STRIDE, np.float64)
    values = carray(at_address(part.values), part.outputs * STRIDE, np.float64)
    taken = carray(at_address(part.taken), part.inputs * STRIDE, np.float64)
    answers = carray(at_address(part.answers), part.outputs * STRIDE, np.float64)
    missed = carray(at_address(part.missed), part.inputs, np.float64)
    for k in range(part.inputs * STRIDE):
        taken[k] = given[k]
    for k in range(part.outputs * STRIDE):
        answers[k] = values[k]
    for i in range(part.inputs):
        missed[i] = 0.0
    memory[0].taken_time, memory[0].taken_step = time, step


@allocating
def answer(memory: np.ndarray) -> None:
    """Outputs of the step that was taken, at the present inputs."""
    part = memory[0]
    n, m, degree = part.inputs, part.outputs, part.degree
    given = carray(at_address(part.given), n * STRIDE, np.float64)
    taken = carray(at_address(part.taken), n * STRIDE, np.float64)
    values = carray(at_address(part.values), m * STRIDE, np.float64)
    answers = carray(at_address(part.answers), m * STRIDE, np.float64)
    feedthrough = carray(at_address(part.feedthrough), m * n, np.float64)
    coefficients = carray(at_address(part.coefficients), n * STRIDE, np.float64)
    missed = carray(at_address(part.missed), n, np.float64)
    for node in range(1, max(1, degree) + 1):
        for j in range(m):
            value = answers[j * STRIDE + node]
            for i in range(n):
                at = i * STRIDE + min(node, degree)
                value += feedthrough[j * n + i] * (given[at] - taken[at])
            values[j * STRIDE + node] = value
            values[j * STRIDE] = value
    for i in range(n):
        mean = _mean(given, i * STRIDE, degree, coefficients)
        missed[i] = mean - _mean(taken, i * STRIDE, degree, coefficients)


@allocating
def _mean(values: np.ndarray, at: int, degree: int, room: np.ndarray) -> float:
    """Mean of a signal over the step."""
    monomial(values, at, degree, room, at)
    total = 0.0
    for j in range(degree, -1, -1):
        total += room[at + j] / (j + 1.0)
    return total


@allocating
def make_up(memory: np.ndarray, step: float) -> None:
    """Add to what is held what the step before has missed."""
    part = memory[0]
    if part.at_end or not part.taken_step > 0.0:
        return
    held = carray(at_address(part.held), 2 * part.inputs, np.float64)
    missed = carray(at_address(part.missed), part.inputs, np.float64)
    for i in range(part.inputs):
        for piece in range(part.pieces):
            held[piece * part.inputs + i] += missed[i] * part.taken_step / step
