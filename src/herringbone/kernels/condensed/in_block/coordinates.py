"""Modal coordinates of the states in the block."""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner, outside
from herringbone.kernels.compiling.views import matrix
from herringbone.kernels.condensed.collocation import less_tangents
from herringbone.kernels.condensed.in_block.arrays import array_kernels
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, kept_size
from herringbone.kernels.condensed.in_block.states import COORDINATES, HOLDS
from herringbone.kernels.condensed.modal import add_product, copy

_NEGLIGIBLE = 1e-5
"""Of the residual that solves a step: what a value moves a coordinate by, at most, over what the
stiff values do, to be left out."""


def enterer(form: Form, at: WorkPlaces, equations: Equations) -> Callable:
    """Compile enter(b, w, t, close): writes coordinates of the states, and the laws there.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, kept, n = equations.owner, equations.kept, form.states
    size, goes_on = kept_size(form) - COORDINATES, equations.kept >= 0
    first = kept + COORDINATES
    laws_there, neglect = _law_writer(form, at, equations), _neglecter(form, at, owner)

    @inner(owner)
    def enter(b: np.ndarray, w: np.ndarray, t: float, close: float) -> None:
        if goes_on and b[kept + HOLDS] != 0.0:
            copy(b[first : first + size], w[at.q : at.q + size])
            for r in range(int(w[at.rotations])):
                w[at.q + 2 * int(w[at.modes]) + r] = 0.0
            return
        inside, modes = int(w[at.inside]), int(w[at.modes])
        x = w[at.x : at.x + inside]
        for i in range(inside):
            state = int(w[at.states + i])
            x[i] = b[state]
            for r in range(int(w[at.rotations])):
                rigid = w[at.rigid + r * n + state]
                if rigid != 0.0:
                    x[i] -= rigid * b[int(w[at.references + r])]
        for k in range(at.q_size):
            w[at.q + k] = 0.0
        back = matrix(w, at.back, inside, 2 * modes)
        add_product(back, x, w[at.q : at.q + 2 * modes])
        laws_there(b, w, t, modes)
        neglect(w, modes, close)
        w[at.before] = -1.0

    return enter


def _law_writer(form: Form, at: WorkPlaces, equations: Equations) -> Callable:
    """Compile laws_there(b, w, t, modes): the laws at the coordinates, as if a step ended there."""
    owner, laws, signals = equations.owner, equations.laws, equations.signals
    given, input_count = equations.inputs, form.inputs
    values, channels, arguments = form.values, form.channels, form.arguments
    first_signal, signal_count, first_input = form.values, form.signals, form.values + form.signals
    degree, count, capacity = form.degree, form.degree + 1, at.capacity
    table_of, nodes_of, _ = array_kernels(form, at, owner)

    @outside(owner)
    def laws_there(b: np.ndarray, w: np.ndarray, t: float, modes: int) -> None:
        table, nodes, u = table_of(w), nodes_of(w), w[at.now :]
        z = nodes.start
        signals(b, t, u[first_signal : first_signal + signal_count])
        for k in range(input_count):
            u[first_input + k] = b[given[k]]
        u[channels - 1] = 1.0
        for a in range(arguments):
            z[a] = 0.0
            for r in range(int(w[at.rotations])):
                z[a] += w[at.of_angles + r * arguments + a] * b[int(w[at.references + r])]
            for c in range(values, channels):
                z[a] += w[at.of_channels + a * channels + c] * u[c]
        for mode in range(modes):
            x, y, row = w[at.q + mode], w[at.q + modes + mode], at.carg + mode
            for a in range(arguments):
                z[a] += w[row + a * capacity] * x - w[row + (arguments + a) * capacity] * y
        laws(b, t, z, nodes.f[0], nodes.k[0], nodes.e[0])
        for value in range(values):
            table.scale[value] = abs(nodes.f[0, value])
            end = at.last + value * count + degree
            w[end] = less_tangents(table, value, nodes.f[0, value], z)

    return laws_there


def _neglecter(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile neglect(w, modes, close): finds what of the laws' values is too small to be felt."""
    values, channels, capacity = form.values, form.channels, at.capacity
    stiff, unknowns = np.array(form.stiff), len(form.stiff)

    @outside(owner)
    def moved(w: np.ndarray, mode: int, channel: int) -> float:
        """What a channel moves a mode by."""
        place = at.bq + channel * capacity + mode
        return abs(w[place]) + abs(w[place + channels * capacity])

    @outside(owner)
    def neglect(w: np.ndarray, modes: int, close: float) -> None:
        for value in range(values):
            w[at.least + value] = 0.0
            felt = np.inf
            for s in range(unknowns):
                if value == int(stiff[s]):
                    felt = 0.0
            for mode in range(modes):
                if felt == 0.0:
                    break
                own = moved(w, mode, value)
                if own > 0.0:
                    by_stiff = 0.0
                    for s in range(unknowns):
                        other = int(stiff[s])
                        by_stiff = max(by_stiff, moved(w, mode, other) * w[at.scale + other])
                    felt = min(felt, by_stiff / own)
            if felt < np.inf:
                w[at.least + value] = _NEGLIGIBLE * close * felt

    return neglect
