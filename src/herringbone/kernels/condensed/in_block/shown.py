"""Outputs and states of a component from its modal coordinates, those alone that are asked for.

What was asked for once is made together from then on: one product of a matrix that holds these
rows alone. A row has the same bits in any company, as its sum has the same order there.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner, outside
from herringbone.kernels.compiling.views import matrix
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, output_places
from herringbone.kernels.condensed.in_block.seen import in_lines
from herringbone.kernels.condensed.modal import add_product
from herringbone.kernels.signals import STRIDE

STALE, HOLDS, COORDINATES = 0, 1, 2
"""Places in what a core goes on with: which of the states and outputs in the block do not belong to
it, ALL or the UNASKED ones; 1 where the rest holds; then the coordinates, with angles themselves
where their growth stands in a step."""
UNASKED, ALL = 1, 2


def show_kernels(  # noqa: PLR0915 (kernels that share their layout)
    form: Form, at: WorkPlaces, equations: Equations
) -> tuple[Callable, Callable]:
    """Compile what writes states and outputs to the block, where they are stale.

    They are asked(b, w, t, references, count), for so many places in the block, and
    everything(b, w, t), at the time t [s] of the coordinates. The condensed form is known.
    """
    owner, kept, prepare, show = equations.owner, equations.kept, equations.prepare, equations.show
    n, channels, outputs, count_of = form.states, form.channels, form.outputs, form.degree + 1
    first, with_nodes = form.shown.first, form.shown.with_nodes
    width, places = STRIDE * with_nodes, output_places(form.shown)
    part, parts = np.array([*form.shown.part, -1]), len(form.shown.states)
    state_first = np.array([a for a, _ in form.shown.states] + [0])
    state_end = np.array([b for _, b in form.shown.states] + [0])
    feeding = np.array([k for own in form.shown.feeding for k in own] + [0])
    feeding_first = np.cumsum([0, *map(len, form.shown.feeding)])
    last = kept + COORDINATES + at.last - at.q

    @outside(owner)
    def ask(w: np.ndarray, row: int) -> None:
        """Ask for a row of `seen`."""
        if w[at.known + row] == 0.0:
            w[at.known + row] = 1.0
            w[at.asked + int(w[at.asking])] = row
            w[at.asking] += 1.0

    @outside(owner)
    def ask_state(w: np.ndarray, state: int) -> None:
        if w[at.inside_of + state] >= 0.0:
            ask(w, int(w[at.inside_of + state]))

    @outside(owner)
    def ask_output(w: np.ndarray, k: int) -> bool:
        """True if a part makes it that has not been needed so far."""
        ask(w, int(w[at.inside]) + k)
        new = w[at.bent + k] != 0.0 and w[at.need + part[k]] == 0.0
        if new:
            w[at.need + part[k]] = 1.0
        return new

    @outside(owner)
    def ask_for_parts(w: np.ndarray) -> None:
        """Ask for what the parts need that make outputs."""
        again = True
        while again:
            again = False
            for p in range(parts):
                if w[at.need + p] != 0.0:
                    for state in range(state_first[p], state_end[p]):
                        ask_state(w, state)
                    for k in range(feeding_first[p], feeding_first[p + 1]):
                        again = ask_output(w, feeding[k]) or again

    @outside(owner)
    def pack(w: np.ndarray) -> None:
        """Write the rows that were asked for side by side."""
        count = int(w[at.asking])
        size, of = in_lines(count), in_lines(int(w[at.inside]) + outputs)
        for i in range(2 * int(w[at.modes]) + int(w[at.rotations]) + channels):
            for k in range(size):
                w[at.packed + i * size + k] = 0.0
            for k in range(count):
                w[at.packed + i * size + k] = w[at.seen + i * of + int(w[at.asked + k])]

    @inner(owner)
    def product(b: np.ndarray, w: np.ndarray, place: int, size: int) -> None:
        """Write values of rows."""
        modes, rotations = int(w[at.modes]), int(w[at.rotations])
        y, q, now = w[at.values : at.values + size], b[kept + COORDINATES :], w[at.now :]
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

    @outside(owner)
    def by_parts(b: np.ndarray, w: np.ndarray, t: float, need: np.ndarray) -> None:
        """Write the outputs that are not affine of parts that are needed."""
        needed = 0.0
        for p in range(parts):
            needed += need[p]
        if needed != 0.0:
            prepare(b)
            show(b, w[at.now :], t, need, w[at.bent :])

    @inner(owner)
    def asked(b: np.ndarray, w: np.ndarray, t: float, references: np.ndarray, count: int) -> None:
        before = w[at.asking]
        for i in range(count):
            place = int(references[i])
            of = place - first
            if place < n:
                ask_state(w, place)
            elif 0 <= of < width:
                ask_output(w, of // STRIDE)
            elif width <= of < width + outputs - with_nodes:
                ask_output(w, of - width + with_nodes)
        if w[at.asking] != before:
            ask_for_parts(w)
            pack(w)
        elif b[kept + STALE] != ALL:
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

    return asked, everything


AT_ONCE, LATER, ANEW = 0, 1, 2
"""How outputs are made: as they follow from the step, the same when they are asked for, or from the
inputs of now."""


def shower(form: Form, at: WorkPlaces, equations: Equations, settle: Callable) -> Callable:
    """Compile show(b, w, t, how) -> bool: writes states and outputs at the end of a step.

    False if nothing is made but when it is asked for.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
        settle: kernel (b, w), makes states that are stale.
    """
    owner, kept, out = equations.owner, equations.kept, equations.out

    @inner(owner)
    def anew(b: np.ndarray, w: np.ndarray, t: float, how: int) -> bool:
        settle(b, w)
        out(b, t)
        return True

    if not form.outputs:
        return anew
    _, everything = show_kernels(form, at, equations)

    @inner(owner)
    def show(b: np.ndarray, w: np.ndarray, t: float, how: int) -> bool:
        if how == ANEW or b[kept + HOLDS] == 0.0 or w[at.showing] == 0.0:
            return anew(b, w, t, how)
        if how == AT_ONCE:
            everything(b, w, t)
        return how == AT_ONCE

    return show
