"""Modal coordinates of the states in the block."""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner, outside
from herringbone.kernels.compiling.views import matrix
from herringbone.kernels.condensed.collocation import less_tangents
from herringbone.kernels.condensed.in_block.arrays import array_kernels
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, kept_size
from herringbone.kernels.condensed.in_block.shown import ALL, COORDINATES, HOLDS, STALE
from herringbone.kernels.condensed.modal import add_product, copy

_NEGLIGIBLE = 1e-5
"""Of the residual that solves a step: what a value moves a coordinate by, at most, over what the
stiff values do, to be left out."""


def coordinate_kernels(
    form: Form, at: WorkPlaces, equations: Equations
) -> tuple[Callable, Callable, Callable, Callable, Callable]:
    """Compile the ways between states and coordinates.

    They are enter(b, w, t, close), which writes the laws there, too, and leave(b, w). With a place
    for what is kept, states are not made by the latter, but are stale from then on; and there are
    belongs(b, w) -> bool: whether the states that are not stale are to the bit those that follow
    from it; settle(b, w): makes states that are stale; and forget(b, w): does so, as they are to be
    changed.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, kept, n = equations.owner, equations.kept, form.states
    size, goes_on = kept_size(form) - COORDINATES, equations.kept >= 0
    first = kept + COORDINATES
    laws_there, neglect = _law_writer(form, at, equations), _neglecter(form, at, owner)
    states_of, kept_states, write_states = _state_writers(form, at, equations)

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

    @inner(owner)
    def leave(b: np.ndarray, w: np.ndarray) -> None:
        modes = int(w[at.modes])
        for r in range(int(w[at.rotations])):
            b[int(w[at.references + r])] += w[at.q + 2 * modes + r]
            w[at.q + 2 * modes + r] = 0.0
        if goes_on:
            b[kept + HOLDS], b[kept + STALE] = 1.0, ALL
            copy(w[at.q : at.q + size], b[first : first + size])
            for r in range(int(w[at.rotations])):
                b[first + 2 * modes + r] = b[int(w[at.references + r])]
        else:
            states_of(b, w)
            write_states(b, w)

    @outside(owner)
    def belongs(b: np.ndarray, w: np.ndarray) -> bool:
        if not goes_on or b[kept + HOLDS] == 0.0:
            return False
        if b[kept + STALE] != 0.0:
            return True
        kept_states(b, w)
        for i in range(int(w[at.inside])):
            if b[int(w[at.states + i])] != w[at.x + i]:
                return False
        return True

    @inner(owner)
    def settle(b: np.ndarray, w: np.ndarray) -> None:
        if goes_on and b[kept + STALE] != 0.0:
            kept_states(b, w)
            write_states(b, w)
            b[kept + STALE] = 0.0

    @inner(owner)
    def forget(b: np.ndarray, w: np.ndarray) -> None:
        if goes_on:
            settle(b, w)
            b[kept + HOLDS] = 0.0

    return enter, leave, belongs, settle, forget


def _state_writers(
    form: Form, at: WorkPlaces, equations: Equations
) -> tuple[Callable, Callable, Callable]:
    """Compile states_of, kept_states and write_states, each (b, w).

    The states inside, in `at.x`, at the angles of the block and the coordinates there or those that
    are kept; and from `at.x` to the block.
    """
    owner, n, first = equations.owner, form.states, equations.kept + COORDINATES

    @inner(owner)
    def states_of(b: np.ndarray, w: np.ndarray) -> None:
        """Write the states inside to `at.x`, at the angles of the block."""
        inside, modes = int(w[at.inside]), int(w[at.modes])
        x = w[at.x : at.x + inside]
        for i in range(inside):
            x[i] = 0.0
        shapes = matrix(w, at.shapes, 2 * modes, inside)
        add_product(shapes, w[at.q : at.q + 2 * modes], x)
        for r in range(int(w[at.rotations])):
            angle, v = b[int(w[at.references + r])], w[at.rigid + r * n : at.rigid + (r + 1) * n]
            for i in range(inside):
                x[i] += v[int(w[at.states + i])] * angle

    @outside(owner)
    def kept_states(b: np.ndarray, w: np.ndarray) -> None:
        """As `states_of`, at the coordinates that are kept."""
        copy(b[first : first + at.q_size], w[at.q : at.q + at.q_size])
        states_of(b, w)

    @inner(owner)
    def write_states(b: np.ndarray, w: np.ndarray) -> None:
        for i in range(int(w[at.inside])):
            b[int(w[at.states + i])] = w[at.x + i]

    return states_of, kept_states, write_states


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
