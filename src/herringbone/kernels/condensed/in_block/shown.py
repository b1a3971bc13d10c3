"""Outputs and states of a component from its modal coordinates, those alone that are asked for.

What was asked for once is made together from then on: one product of a matrix that holds these
rows alone. A row has the same bits in any company, as its sum has the same order there.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inner, outside
from herringbone.kernels.compiling.views import matrix
from herringbone.kernels.condensed.in_block.asked_rows import row_asker
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, output_places
from herringbone.kernels.condensed.in_block.states import ALL, COORDINATES, HOLDS, STALE, UNASKED
from herringbone.kernels.condensed.lines import in_lines
from herringbone.kernels.condensed.modal import add_product
from herringbone.kernels.stepping.leaping import ANEW, AT_ONCE


class ShowKernels(NamedTuple):
    """What writes states and outputs to the block where they are stale.

    The condensed form is known, and t [s] is the time of the coordinates.

    Attributes:
        asked: (b, w, t, references, count), those at so many places in the block.
        everything: (b, w, t).
    """

    asked: Callable
    everything: Callable


def show_kernels(form: Form, at: WorkPlaces, equations: Equations) -> ShowKernels:
    """Compile what writes states and outputs that the coordinates give.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, kept = equations.owner, equations.kept
    outputs, parts = form.outputs, len(form.shown.states)
    part, ask_for = np.array([*form.shown.part, -1]), row_asker(form, at, owner)
    product, write = _row_product(form, at, equations), _row_writer(form, at, owner)
    by_parts = _part_shower(form, at, equations)

    @inner(owner)
    def asked(b: np.ndarray, w: np.ndarray, t: float, references: np.ndarray, count: int) -> None:
        if not ask_for(w, references, count) and b[kept + STALE] != ALL:
            return
        rows = int(w[at.asking])
        product(b, w, at.packed, in_lines(rows))
        for k in range(rows):
            write(b, w, int(w[at.asked + k]), w[at.values + k])
        by_parts(b, w, t, w[at.need : at.need + parts])
        b[kept + STALE] = UNASKED

    @outside(owner)
    def everything(b: np.ndarray, w: np.ndarray, t: float) -> None:
        count = int(w[at.inside]) + outputs
        product(b, w, at.seen, in_lines(count))
        for k in range(count):
            write(b, w, k, w[at.values + k])
        need = w[at.values : at.values + parts]
        for p in range(parts):
            need[p] = 0.0
        for k in range(outputs):
            if w[at.bent + k] != 0.0:
                need[part[k]] = 1.0
        by_parts(b, w, t, need)
        b[kept + STALE] = 0.0

    return ShowKernels(asked, everything)


def _row_product(form: Form, at: WorkPlaces, equations: Equations) -> Callable:
    """Compile product(b, w, place, size), of rows that stand there."""
    channels, count_of, first = form.channels, form.degree + 1, equations.kept + COORDINATES
    last = first + at.last - at.q

    @inner(equations.owner)
    def product(b: np.ndarray, w: np.ndarray, place: int, size: int) -> None:
        """Write values of rows."""
        modes, rotations = int(w[at.modes]), int(w[at.rotations])
        y, q, now = w[at.values : at.values + size], b[first:], w[at.now :]
        for k in range(size):
            y[k] = 0.0
        add_product(matrix(w, place, 2 * modes, size), q[: 2 * modes], y)
        for r in range(rotations):
            angle, row = q[2 * modes + r], w[place + (2 * modes + r) * size :]
            b[int(w[at.references + r])] = angle
            for k in range(size):
                y[k] += angle * row[k]
        for c in range(channels):
            now[c] = b[last + (c + 1) * count_of - 1]
        of_channels = place + (2 * modes + rotations) * size
        add_product(matrix(w, of_channels, channels, size), now[:channels], y)

    return product


def _row_writer(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile write(b, w, row, value)."""
    with_nodes, places = form.shown.with_nodes, output_places(form.shown)

    @inner(owner)
    def write(b: np.ndarray, w: np.ndarray, row: int, value: float) -> None:
        """Write the value of a row of `seen` to its place."""
        output = row - int(w[at.inside])
        if output < 0:
            b[int(w[at.states + row])] = value
        else:
            place = int(places[output])
            b[place] = value
            if output < with_nodes:
                b[place + 1] = value

    return write


def _part_shower(form: Form, at: WorkPlaces, equations: Equations) -> Callable:
    """Compile by_parts(b, w, t, need)."""
    owner, prepare, show = equations.owner, equations.prepare, equations.show
    parts = len(form.shown.states)

    @outside(owner)
    def by_parts(b: np.ndarray, w: np.ndarray, t: float, need: np.ndarray) -> None:
        """Write the outputs that are not affine of parts that are needed."""
        needed = 0.0
        for p in range(parts):
            needed += need[p]
        if needed != 0.0:
            prepare(b)
            show(b, w[at.now :], t, need, w[at.bent :])

    return by_parts


def shower(
    form: Form, at: WorkPlaces, equations: Equations, settle: Callable, everything: Callable
) -> Callable:
    """Compile show(b, w, t, how) -> bool, see `Leaps`.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
        settle: kernel (b, w), makes states that are stale.
        everything: see `ShowKernels`.
    """
    owner, kept, out = equations.owner, equations.kept, equations.out

    @inner(owner)
    def anew(b: np.ndarray, w: np.ndarray, t: float, how: int) -> bool:
        settle(b, w)
        out(b, t)
        return True

    if not form.outputs:
        return anew

    @inner(owner)
    def show(b: np.ndarray, w: np.ndarray, t: float, how: int) -> bool:
        if how == ANEW or b[kept + HOLDS] == 0.0 or w[at.showing] == 0.0:
            return anew(b, w, t, how)
        if how == AT_ONCE:
            everything(b, w, t)
        return how == AT_ONCE

    return show
