"""Rows of states and outputs that are asked for, packed side by side in the work space.

What was asked for once stays.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner, outside
from herringbone.kernels.condensed.in_block.form import Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces
from herringbone.kernels.condensed.lines import in_lines
from herringbone.kernels.signals import STRIDE


def row_asker(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile ask_for(w, references, count) -> bool, for so many places in the block.

    True if there are rows that were not asked for so far; then all are packed anew.
    """
    n, outputs, first = form.states, form.outputs, form.shown.first
    with_nodes, width = form.shown.with_nodes, STRIDE * form.shown.with_nodes
    ask_state, ask_output = _askers(form, at, owner)
    ask_for_parts = _part_asker(form, at, owner, ask_state, ask_output)
    pack = _packer(form, at, owner)

    @inner(owner)
    def ask_for(w: np.ndarray, references: np.ndarray, count: int) -> bool:
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
        if w[at.asking] == before:
            return False
        ask_for_parts(w)
        pack(w)
        return True

    return ask_for


def _askers(form: Form, at: WorkPlaces, owner: str) -> tuple[Callable, Callable]:
    """Compile ask_state(w, state) and ask_output(w, k) -> bool."""
    part = np.array([*form.shown.part, -1])

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

    return ask_state, ask_output


def _part_asker(
    form: Form, at: WorkPlaces, owner: str, ask_state: Callable, ask_output: Callable
) -> Callable:
    """Compile ask_for_parts(w)."""
    parts = len(form.shown.states)
    state_first = np.array([a for a, _ in form.shown.states] + [0])
    state_end = np.array([b for _, b in form.shown.states] + [0])
    feeding = np.array([k for own in form.shown.feeding for k in own] + [0])
    feeding_first = np.cumsum([0, *map(len, form.shown.feeding)])

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

    return ask_for_parts


def _packer(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile pack(w)."""
    channels, outputs = form.channels, form.outputs

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

    return pack
