"""What is asked of a periodic motion, and how far an answer is from another one."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from herringbone.analysis.leaner.form import Form
from herringbone.analysis.leaner.views import View
from herringbone.analysis.steady.harmonic_balance.fourier import on
from herringbone.analysis.steady.outputs import harmonics
from herringbone.analysis.steady.state import SteadyState
from herringbone.core.process.one_thread import one_blas_thread

_SAME = 1e-6
"""Relative difference of mesh orders that are one."""


@dataclass(frozen=True)
class Question:
    """What is to be known, and how well.

    Attributes:
        name: for people.
        columns: outputs.
        form: as what.
        tolerance: over the size of all columns together.
        band: end of a spectrum [Hz].
        orders: mesh orders, of amplitudes.
        view: what is made of the columns and asked for; None: they themselves.
    """

    name: str
    columns: tuple[str, ...]
    form: Form
    tolerance: float
    band: float = np.inf
    orders: tuple[float, ...] = ()
    view: View | None = None

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of what is asked for."""
        return self.columns if self.view is None else self.view.names

    def lines(self, given: np.ndarray, orders: np.ndarray, frequency: float) -> np.ndarray:
        """Coefficients (outputs, harmonics) of those of the columns; the period's frequency."""
        return given if self.view is None else self.view.lines(given, orders * frequency)


class Lines(NamedTuple):
    """Harmonics of outputs.

    Attributes:
        coefficients: (columns, harmonics), of ascending orders.
        orders: (harmonics,) whole numbers.
        meshes: periods of the mesh in the period.
        frequency: of the period [Hz].
    """

    coefficients: np.ndarray
    orders: np.ndarray
    meshes: int
    frequency: float

    @property
    def highest(self) -> float:
        """Frequency of the largest line [Hz] but the mean."""
        sizes = np.linalg.norm(self.coefficients, axis=0)
        sizes[0] = 0.0
        return float(self.orders[sizes.argmax()] * self.frequency)


class Apart(NamedTuple):
    """How far an answer is from another one.

    Attributes:
        error: of all columns together.
        worst: the column that is farthest, over its own size.
        worst_error: of that one.
    """

    error: float
    worst: str
    worst_error: float


def lines_of(state: SteadyState, question: Question) -> Lines:
    """Harmonics of what is asked for."""
    with one_blas_thread():
        found = harmonics(state.structure, state.orbit, question.columns)
    own = question.lines(found.coefficients, found.orders, state.frequency)
    return Lines(own, found.orders, state.meshes, state.frequency)


def apart(question: Question, ours: Lines, theirs: Lines) -> Apart:
    """How far an answer is from a better one of the same period."""
    orders = np.union1d(ours.orders, theirs.orders)
    one, other = (
        _asked(question, on(orders, lines.coefficients, lines.orders), orders, theirs)
        for lines in (ours, theirs)
    )
    off, size = (np.linalg.norm(rows, axis=1) for rows in (one - other, other))
    whole = float(np.linalg.norm(size))
    single = np.where(size > 0.0, off / np.where(size > 0.0, size, 1.0), 0.0)
    worst = int(single.argmax())
    error = float(np.linalg.norm(off)) / whole if whole else 0.0
    return Apart(error, question.outputs[worst], float(single[worst]))


def nothing_asked(question: Question, lines: Lines) -> str:
    """Why an answer has no line of what is asked for; "" if it has."""
    if question.form is Form.ORDER:
        mesh = np.array(question.orders) * lines.meshes
        whole = np.isclose(mesh, np.maximum(np.rint(mesh), 1.0), rtol=_SAME, atol=0.0)
        if not whole.all():
            order = question.orders[int(whole.argmin())]
            return f"there is no line of order {order:g}; {_told_orders(lines)}"
    if np.any(_asked(question, lines.coefficients, lines.orders, lines)):
        return ""
    (moving,) = np.nonzero(lines.coefficients[:, 1:].any(axis=0))
    if not moving.size:
        return "it does not vary"
    if question.form is Form.ORDER:
        return f"there is no such line; {_told_orders(lines)}"
    first = lines.orders[1 + moving[0]] * lines.frequency
    return f"there is no line in the band; the first one is at {first:.5g} Hz"


def _told_orders(lines: Lines) -> str:
    """Mesh orders that a motion has, for people."""
    highest = f"{lines.orders[-1] / lines.meshes:.5g}"
    if lines.meshes == 1:
        return f"the period is one mesh, orders are 1, 2, ... {highest}"
    return (
        f"the period is {lines.meshes} meshes, orders are multiples of 1/{lines.meshes} "
        f"up to {highest}"
    )


def _asked(
    question: Question, coefficients: np.ndarray, orders: np.ndarray, lines: Lines
) -> np.ndarray:
    """Rows (columns, n) whose differences count."""
    kept = (orders > 0) & (orders * lines.frequency <= question.band)
    if question.form is Form.LEVEL:
        if question.view is not None and question.view.adds:
            return coefficients[:, kept].sum(axis=1, keepdims=True)
        return np.linalg.norm(coefficients[:, kept], axis=1, keepdims=True)
    if question.form is Form.ORDER:
        mesh = orders / lines.meshes
        near = np.isclose(mesh[:, None], np.array(question.orders)[None, :], rtol=_SAME, atol=0.0)
        return np.abs(coefficients[:, kept & near.any(axis=1)])
    return coefficients[:, kept]
