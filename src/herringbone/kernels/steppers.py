"""How the three kinds of components advance over a macro step.

Each factory compiles one stepper for a component's kernels and layout. The component's own `step`
calls it, and holds the compiled code in its cache.
"""

import math
from collections.abc import Callable

import numpy as np

from herringbone.core.declaring.declaration import Declaration
from herringbone.kernels.compiling.jit import inner, kernel
from herringbone.kernels.signals import STRIDE, all_finite, evaluate, monomial, store_node

Rhs = Callable[[np.ndarray, float, np.ndarray], None]
Out = Callable[[np.ndarray, float], None]
Piece = Callable[[np.ndarray], int]

NOT_FINITE = 1
"""Status of a step whose states (an element's or source's outputs) are NaN or infinite."""
TOO_LONG = 2
"""Status of a step that was refused because it is longer than the component's `longest_step`."""
MOST_MICRO_STEPS = 1e6
"""Most micro steps of one call: seconds of work, after which a master wants to hear something."""
FINER = 8
"""Parts of a micro step in which a law bends: there its order is lost."""


def body_work(state_count: int, input_count: int) -> int:
    """Length of the work space that a body's stepper needs."""
    return 3 * state_count + (STRIDE + 1) * input_count


def element_work(input_count: int) -> int:
    """Length of the work space that an element's stepper needs."""
    return input_count


def longest_step(declaration: Declaration, micro_step: str) -> Callable[[np.ndarray], float]:
    """Compile the `longest_step` of a body that takes micro steps.

    Args:
        declaration: of the component.
        micro_step: name of the parameter that bounds them [s].
    """
    at = declaration.index[micro_step]

    @inner(declaration.name)
    def longest(b: np.ndarray) -> float:
        return MOST_MICRO_STEPS * b[at]

    return longest


def longest_step_by(
    declaration: Declaration, micro_step: Callable[[np.ndarray], float]
) -> Callable[[np.ndarray], float]:
    """As `longest_step`, of a body whose own rates bound its micro steps, too.

    Args:
        declaration: of the component.
        micro_step: kernel (b): the longest one [s].
    """

    @inner(declaration.name)
    def longest(b: np.ndarray) -> float:
        return MOST_MICRO_STEPS * micro_step(b)

    return longest


def input_kernels(declaration: Declaration, at: int) -> tuple[Callable, Callable, Callable]:
    """Compile what a body's stepper does with inputs that are polynomials over the macro step.

    Args:
        declaration: of the body.
        at: where their room in the work space begins, STRIDE + 1 numbers for each.

    Returns:
        expand(b, w, degree), before the first inner step; set(b, w, degree, c), at the place c of
        the macro step; restore(b, w, degree), to what the caller had set. At degree 0 inputs are
        held, and all three do nothing.
    """
    first, count = declaration.first_input, len(declaration.inputs)
    kept = at + STRIDE * count

    @inner(declaration.name)
    def expand_inputs(b: np.ndarray, w: np.ndarray, degree: int) -> None:
        if degree > 0:
            for i in range(count):
                monomial(b, first + i * STRIDE, degree, w, at + i * STRIDE)
                w[kept + i] = b[first + i * STRIDE]

    @inner(declaration.name)
    def set_inputs(b: np.ndarray, w: np.ndarray, degree: int, c: float) -> None:
        if degree > 0:
            for i in range(count):
                b[first + i * STRIDE] = evaluate(w, at + i * STRIDE, degree, c)

    @inner(declaration.name)
    def restore_inputs(b: np.ndarray, w: np.ndarray, degree: int) -> None:
        if degree > 0:
            for i in range(count):
                b[first + i * STRIDE] = w[kept + i]

    return expand_inputs, set_inputs, restore_inputs


@kernel
def one_piece(b: np.ndarray) -> int:
    """The pieces that laws without bends are on."""
    return 0


def _runge_kutta(
    rhs: Rhs, piece: Piece, declaration: Declaration, set_inputs: Callable
) -> Callable[[np.ndarray, np.ndarray, float, float, int, float, float, float, int, bool], int]:
    """Compile one step of classical Runge-Kutta (order 4).

    Returns:
        advance(b, w, t, h, degree, begin, middle, end, on, known) -> int: block, work space, which
        has the states at the start behind the derivatives afterwards, start and length [s],
        interface degree, where begin, middle and end lie in the macro step, the piece that the laws
        are on at the start (-1: not known yet), whether the work space begins with the derivatives
        there; the piece, or -1 if the laws leave it.
    """
    n = declaration.state_count
    x0, slope = n, 2 * n

    @inner(declaration.name)
    def advance(
        b: np.ndarray, w: np.ndarray, t: float, h: float, degree: int, begin: float, middle: float,
        end: float, on: int, known: bool,
    ) -> int:  # fmt: skip
        dx = w[:n]
        set_inputs(b, w, degree, begin)
        if not known:
            rhs(b, t, dx)
        on = piece(b) if on < 0 else on
        for i in range(n):
            w[x0 + i] = b[i]
            w[slope + i] = dx[i]
            b[i] = w[x0 + i] + 0.5 * h * dx[i]
        set_inputs(b, w, degree, middle)
        rhs(b, t + 0.5 * h, dx)
        for i in range(n):
            w[slope + i] += 2.0 * dx[i]
            b[i] = w[x0 + i] + 0.5 * h * dx[i]
        rhs(b, t + 0.5 * h, dx)
        stays = piece(b) == on
        for i in range(n):
            w[slope + i] += 2.0 * dx[i]
            b[i] = w[x0 + i] + h * dx[i]
        set_inputs(b, w, degree, end)
        rhs(b, t + h, dx)
        for i in range(n):
            b[i] = w[x0 + i] + h / 6.0 * (w[slope + i] + dx[i])
        return on if stays and piece(b) == on else -1

    return advance


def body_stepper(
    rhs: Rhs,
    out: Out,
    declaration: Declaration,
    slopes: int | None = None,
    piece: Piece = one_piece,
) -> Callable[[np.ndarray, np.ndarray, float, float, float, int], int]:
    """Compile the step of a body: classical Runge-Kutta (order 4) with equal micro steps.

    A micro step in which a law bends is taken again, in FINER parts. Inputs are polynomials over
    the macro step; outputs are written at every live node. The block's inputs are afterwards what
    the caller had set.

    Args:
        rhs, out: kernels.
        declaration: of the body.
        slopes: where `out` leaves the derivatives of all states in the block, which the next micro
            step begins with; None: nowhere.
        piece: kernel (b) -> int after `rhs` and `out`: on which of their smooth pieces the laws
            are.

    Returns:
        step(b, w, t, h, micro_step, degree) -> int: block, work space (`body_work` long), start
        and length of the macro step [s] (h >= 0), longest micro step [s], interface degree;
        0, NOT_FINITE or, if MOST_MICRO_STEPS would not do, TOO_LONG.
    """
    n = declaration.state_count
    first_output, outputs = declaration.first_output, len(declaration.node_outputs)
    known, left = slopes is not None, slopes or 0
    expand_inputs, set_inputs, restore_inputs = input_kernels(declaration, 3 * n)
    advance = _runge_kutta(rhs, piece, declaration, set_inputs)

    @inner(declaration.name)
    def step(
        b: np.ndarray, w: np.ndarray, t: float, h: float, micro_step: float, degree: int
    ) -> int:
        if not h <= MOST_MICRO_STEPS * micro_step:
            return TOO_LONG
        expand_inputs(b, w, degree)
        intervals = max(degree, 1)
        count = max(1, math.ceil(h / (intervals * micro_step) - 1e-9))
        total = intervals * count
        hs = h / total
        dx, on = w[:n], -1
        k, part, parts = 0, 0, 1
        while k < total:
            found = known and parts == 1 and k > 0 and k % count == 0
            if found:
                for i in range(n):
                    dx[i] = b[left + i]
            begin, middle = (k + part / parts) / total, (k + (part + 0.5) / parts) / total
            end = (k + (part + 1) / parts) / total
            ts = t + k * hs + hs * part / parts
            on = advance(b, w, ts, hs / parts, degree, begin, middle, end, on, found)
            if on < 0 and parts == 1:  # again
                for i in range(n):
                    b[i] = w[n + i]
                parts = FINER
                continue
            part += 1
            if parts > 1:
                on = -1
            if part == parts:
                k, part, parts = k + 1, 0, 1
                if k % count == 0:
                    out(b, t + k * hs)
                    store_node(b, first_output, outputs, k // count)
        restore_inputs(b, w, degree)
        return 0 if all_finite(b, 0, n) else NOT_FINITE

    return step


def element_stepper(
    out: Out, declaration: Declaration
) -> Callable[[np.ndarray, np.ndarray, float, float, int], int]:
    """Compile the step of a massless element: evaluated at every live node of its inputs.

    At degree 0 it is evaluated at the inputs' values.

    Returns:
        step(b, w, t, h, degree) -> int: block, work space (`element_work` long), start and length
        of the macro step [s], interface degree; 0, or NOT_FINITE.
    """
    first_input, inputs = declaration.first_input, len(declaration.inputs)
    first_output, outputs = declaration.first_output, len(declaration.node_outputs)

    @inner(declaration.name)
    def step(b: np.ndarray, w: np.ndarray, t: float, h: float, degree: int) -> int:
        for i in range(inputs):
            w[i] = b[first_input + i * STRIDE]
        for node in range(1, degree + 1):
            for i in range(inputs):
                b[first_input + i * STRIDE] = b[first_input + i * STRIDE + node]
            out(b, t + h * node / degree)
            store_node(b, first_output, outputs, node)
        if degree == 0:
            out(b, t + h)
            store_node(b, first_output, outputs, 1)
        for i in range(inputs):
            b[first_input + i * STRIDE] = w[i]
        return 0 if all_finite(b, first_output, STRIDE * outputs) else NOT_FINITE

    return step


def source_stepper(
    out: Out, declaration: Declaration
) -> Callable[[np.ndarray, float, float, int], int]:
    """Compile the step of a component without inputs: evaluated at every live node.

    Returns:
        step(b, t, h, degree) -> int: block, start and length of the macro step [s], interface
        degree; 0, or NOT_FINITE.
    """
    first_output, outputs = declaration.first_output, len(declaration.node_outputs)

    @inner(declaration.name)
    def step(b: np.ndarray, t: float, h: float, degree: int) -> int:
        intervals = max(degree, 1)
        for node in range(1, intervals + 1):
            out(b, t + h * node / intervals)
            store_node(b, first_output, outputs, node)
        return 0 if all_finite(b, first_output, STRIDE * outputs) else NOT_FINITE

    return step
