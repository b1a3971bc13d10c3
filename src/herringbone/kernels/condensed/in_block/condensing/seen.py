"""Rows of states and outputs over modal coordinates, angles and channels."""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.form import Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, taken_places
from herringbone.kernels.condensed.lines import in_lines

_SAME = 1e-9
"""Of the terms that are added: what grows less with an angle does not know it."""


def seen_arranger(form: Form, at: WorkPlaces, owner: str) -> Callable[[np.ndarray], None]:
    """Compile arrange_seen(w): writes rows of states and outputs, before modes are arranged.

    It tells if outputs can be shown: those that are not affine are of parts that make them alone.

    Args:
        form: of the component.
        at: places in the work space.
        owner: of the kernels.
    """
    n, channels, outputs = form.states, form.channels, form.outputs
    part = np.array([*form.shown.part, -1])
    see, see_state = _row_writer(form, at, owner), _state_row_writer(form, at, owner)

    @outside(owner)
    def arrange_seen(w: np.ndarray) -> None:
        w[at.showing] = 1.0
        for k in range(outputs):
            if w[at.bent + k] != 0.0 and part[k] < 0:
                w[at.showing] = 0.0
        count, modes, rotations = int(w[at.inside]), int(w[at.modes]), int(w[at.rotations])
        size = in_lines(count + outputs)
        for k in range((2 * modes + rotations + channels) * size):
            w[at.seen + k] = 0.0
        for i in range(n):
            w[at.inside_of + i] = -1.0
        for i in range(count):
            state = int(w[at.states + i])
            w[at.inside_of + state] = i
            see_state(w, i, state, at.seen + i, size)
        for k in range(outputs):
            see(w, n + k, at.seen + count + k, size)

    return arrange_seen


def _row_writer(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile see(w, row, to, size): what a row over states and channels is of the others.

    These are coordinates, angles and channels.
    """
    n, channels, capacity = form.states, form.channels, at.capacity
    of = taken_places(form, at.rungs)

    @outside(owner)
    def see(w: np.ndarray, row: int, to: int, size: int) -> None:
        count, modes, rotations = int(w[at.inside]), int(w[at.modes]), int(w[at.rotations])
        over = w[of.whole + row * n : of.whole + (row + 1) * n]
        k = 0
        for mode in range(modes):
            pair, g, h = w[at.rates + capacity + mode] != 0.0, 0.0, 0.0
            for i in range(count):
                value = over[int(w[at.states + i])]
                g += value * w[at.shapes + i * count + k]
                if pair:
                    h -= value * w[at.shapes + i * count + k + 1]
            w[to + mode * size], w[to + (modes + mode) * size] = g, h
            k += 2 if pair else 1
        for r in range(rotations):
            total, terms = 0.0, 0.0
            for i in range(n):
                term = over[i] * w[at.rigid + r * n + i]
                total += term
                terms += abs(term)
            w[to + (2 * modes + r) * size] = total if abs(total) > _SAME * terms else 0.0
        for c in range(channels):
            place = to + (2 * modes + rotations + c) * size
            w[place] = w[of.of_inputs + row * channels + c]

    return see


def _state_row_writer(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile see_state(w, i, state, to, size): the row of a state, the one inside i."""
    n, capacity = form.states, at.capacity

    @outside(owner)
    def see_state(w: np.ndarray, i: int, state: int, to: int, size: int) -> None:
        count, modes, k = int(w[at.inside]), int(w[at.modes]), 0
        for mode in range(modes):
            w[to + mode * size] = w[at.shapes + i * count + k]
            if w[at.rates + capacity + mode] != 0.0:
                w[to + (modes + mode) * size] = -w[at.shapes + i * count + k + 1]
                k += 1
            k += 1
        for r in range(int(w[at.rotations])):
            w[to + (2 * modes + r) * size] = w[at.rigid + r * n + state]

    return see_state
