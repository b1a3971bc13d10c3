"""The laws over a step, collocated at its nodes; as `collocation`, in flat arrays."""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.condensed.in_block.columns import add_columns, solve
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces

_ITERATIONS = 5
_TINY = 1e-300
_ROUNDED = 1e-13
"""Of a value: a residual below is rounding."""


def difference_kernel(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile differences(w, first, end), of channels."""
    count = form.degree + 1

    @inner(owner)
    def differences(w: np.ndarray, first: int, end: int) -> None:
        """Write the inputs of some channels, see `rung`."""
        for channel in range(first, end):
            own, to = at.u + channel * count, at.v + channel * count
            w[to] = w[own]
            for i in range(1, count):
                w[to + i] = w[own + i] - w[own]

    return differences


def iteration(  # noqa: PLR0915 (kernels that share their layout)
    form: Form, at: WorkPlaces, equations: Equations
) -> Callable:
    """Compile iterate(b, w, begin, close) -> bool, with the rung that begins there.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, laws = equations.owner, equations.laws
    values, stiff, unknowns = form.values, np.array(form.stiff), len(form.stiff)
    arguments, kinks, rows = form.arguments, form.kinks, at.rows
    tangent, of_tangent = form.tangent.ravel(), np.array(form.of_tangent)
    mean, tangents = form.mean, len(form.mean)
    degree, count, size = form.degree, form.degree + 1, len(form.stiff) * form.degree
    differences = difference_kernel(form, at, owner)

    @inner(owner)
    def residual(w: np.ndarray) -> float:
        """Residuals of the laws' values at the nodes; the largest one, over its value."""
        worst = 0.0
        s = 0
        for value in range(values):
            own = w[at.u + value * count + 1 : at.u + (value + 1) * count]
            if s == unknowns or value != int(stiff[s]):
                for i in range(degree):
                    own[i] = w[at.f + i * values + value]
                continue
            off, scale = 0.0, _TINY
            to = w[at.r + s * degree : at.r + (s + 1) * degree]
            for i in range(degree):
                to[i] = w[at.f + i * values + value]
                scale = max(scale, abs(to[i]), abs(own[i]))
            for a in range(arguments):
                by = tangent[s * arguments + a]
                if by != 0.0:
                    for i in range(degree):
                        to[i] -= by * w[at.at_nodes + i * arguments + a]
            for i in range(degree):
                to[i] -= own[i]
                if not abs(to[i]) <= max(off, _ROUNDED * abs(own[i])):
                    off = abs(to[i])
            if not off <= worst * scale:
                worst = off / scale
            s += 1
        return worst

    @inner(owner)
    def correct(w: np.ndarray, along: int) -> None:
        """Correct the stiff values by one step of Newton."""
        for k in range(size * size):
            w[at.matrix + k] = 0.0
        for k in range(size):
            w[at.matrix + k * size + k] = 1.0
        for i in range(degree):
            for tangent_ in range(tangents):
                rest = w[at.k + i * tangents + tangent_] - mean[tangent_]
                row = at.matrix + (int(of_tangent[tangent_]) * degree + i) * size
                own = along + (i * tangents + tangent_) * size
                for column in range(size):
                    w[row + column] -= rest * w[own + column]
        solve(w[at.matrix : at.matrix + size * size], w[at.r : at.r + size], size)
        for s in range(unknowns):
            own = at.u + int(stiff[s]) * count + 1
            for i in range(degree):
                w[own + i] += w[at.r + s * degree + i]

    @inner(owner)
    def iterate(b: np.ndarray, w: np.ndarray, begin: int, close: float) -> bool:
        """Find the laws' values of a step; False if the iteration does not end."""
        for _ in range(_ITERATIONS):
            for row in range(rows):
                w[at.at_nodes + row] = w[at.free + row]
            differences(w, 0, values)
            of_inputs = w[begin + at.of_inputs :]
            add_columns(of_inputs, rows, w[at.v :], values * count, w[at.at_nodes :], rows)
            for i in range(degree):
                laws(
                    b,
                    w[at.at_nodes + i * arguments : at.at_nodes + (i + 1) * arguments],
                    w[at.f + i * values : at.f + (i + 1) * values],
                    w[at.k + i * tangents : at.k + (i + 1) * tangents],
                    w[at.e + (i + 1) * kinks : at.e + (i + 2) * kinks],
                )
            off = residual(w)
            if not off < np.inf:
                return False
            correct(w, begin + at.along)
            if off <= close:
                return True
        return False

    return iterate


def doubts(form: Form, at: WorkPlaces, owner: str) -> tuple[Callable, Callable]:
    """Compile bends(w) -> bool and rough(w) -> float, of a step that is solved."""
    degree, count, kinks, values = form.degree, form.degree + 1, form.kinks, form.values
    stiff, unknowns = np.array(form.stiff), len(form.stiff)
    top = form.fit[-1]
    top_size = np.abs(top).sum()

    @inner(owner)
    def bends(w: np.ndarray) -> bool:
        """True if an indicator changes its sign between two nodes."""
        for k in range(degree * kinks):
            if w[at.e + k] * w[at.e + kinks + k] < 0.0:
                return True
        return False

    @inner(owner)
    def rough(w: np.ndarray) -> float:
        """Highest power of the stiff values over a step, over the force."""
        worst = 0.0
        for s in range(unknowns):
            own = at.u + int(stiff[s]) * count
            high, scale = 0.0, _TINY
            for i in range(count):
                high += top[i] * w[own + i]
                scale = max(scale, abs(w[own + i]))
            for i in range(degree):
                scale = max(scale, abs(w[at.f + i * values + int(stiff[s])]))
            worst = max(worst, abs(high) / (top_size * scale))
        return worst

    return bends, rough
