"""Channels in a state of a component, and which of its outputs are not affine in them."""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import (
    WorkPlaces,
    output_places,
    taken_places,
)

_SAME = 1e-9
"""Of an output, over the sizes of the terms that are added: a difference below is rounding."""
_FARTHER = (-10.0, 0.1, 100.0)
"""Usual sizes by which states and inputs are moved to see which outputs are affine."""
LONG_AFTER = 1e3
"""Time [s] after which nothing is brought in any more."""


def channel_writer(form: Form, at: WorkPlaces, equations: Equations) -> Callable:
    """Compile channels_at(b, w, t): the channels in the state of `at.x`.

    Laws' values are less their mean tangents.
    """
    owner, inputs, given = equations.owner, equations.inputs, equations.given
    laws, signals = equations.laws, equations.signals
    n, channels, arguments, values = form.states, form.channels, form.arguments, form.values
    stiff, unknowns, tangent = np.array(form.stiff), len(form.stiff), form.tangent.ravel()
    signal_count, first_input, input_count = form.signals, values + form.signals, form.inputs
    of, rows = taken_places(form, at.rungs), n + form.outputs

    @outside(owner)
    def channels_at(b: np.ndarray, w: np.ndarray, t: float) -> None:
        x, u, z = w[at.x : at.x + n], w[at.now :], w[at.start : at.start + arguments]
        signals(b, t, u[values : values + signal_count])
        for k in range(input_count):
            u[first_input + k] = b[inputs[k]]
        given(b, x, u, w[of.rates : of.rates + rows], z)
        laws(b, t, z, u, w[at.k :], w[at.e :])
        for s in range(unknowns):
            for k in range(arguments):
                u[int(stiff[s])] -= tangent[s * arguments + k] * z[k]
        u[channels - 1] = 1.0

    return channels_at


def bent_finder(
    form: Form, at: WorkPlaces, equations: Equations, channels_at: Callable
) -> Callable:
    """Compile find_bent(b, w, t): notes the outputs that are not affine.

    States and inputs are those in `of.room`.
    """
    owner, sizes, inputs = equations.owner, np.array(equations.sizes), equations.inputs
    out, n, channels, input_count = equations.out, form.states, form.channels, form.inputs
    of, farther, outputs = taken_places(form, at.rungs), np.array(_FARTHER), form.outputs
    places, timed = output_places(form.shown), np.array([*form.shown.timed, -1])

    @outside(owner)
    def note_bent(b: np.ndarray, w: np.ndarray, t: float) -> None:
        """Note the outputs that are not those of the form in the block's state."""
        for i in range(n):
            w[at.x + i] = b[i]
        channels_at(b, w, t)
        out(b, t)
        for k in range(outputs):
            row, y, terms = n + k, 0.0, 1e-300
            for i in range(n):
                term = w[of.whole + row * n + i] * b[i]
                y += term
                terms += abs(term)
            for c in range(channels):
                term = w[of.of_inputs + row * channels + c] * w[at.now + c]
                y += term
                terms += abs(term)
            if not abs(y - b[int(places[k])]) <= _SAME * terms:
                w[at.bent + k] = 1.0

    @outside(owner)
    def find_bent(b: np.ndarray, w: np.ndarray, t: float) -> None:
        kept = w[of.room : of.room + n + input_count]
        for k in range(outputs):
            w[at.bent + k] = 0.0
        for k in range(timed.size - 1):
            w[at.bent + timed[k]] = 1.0
        note_bent(b, w, t)
        for k in range(farther.size):
            far = farther[k]
            for i in range(n):
                b[i] = kept[i] + far * sizes[i] * (1.0 + 0.125 * (i % 8))
            for j in range(input_count):
                b[inputs[j]] = kept[n + j] + far * (1.0 + abs(kept[n + j]))
            note_bent(b, w, t + LONG_AFTER)
        for k in range(input_count):
            b[inputs[k]] = kept[n + k]

    return find_bent
