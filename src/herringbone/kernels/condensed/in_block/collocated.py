"""The laws over a step, collocated at its nodes, in a component's block."""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner, outside
from herringbone.kernels.compiling.views import integers, matrix
from herringbone.kernels.condensed.channels import inputs
from herringbone.kernels.condensed.collocation import hidden, residuals, spread
from herringbone.kernels.condensed.correction import correct
from herringbone.kernels.condensed.in_block.arrays import array_kernels, sharp_directions
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces
from herringbone.kernels.condensed.modal import add_chosen, copy, turn

_ITERATIONS = 5
_TINY = 1e-300


def iteration(form: Form, at: WorkPlaces, equations: Equations) -> Callable:
    """Compile iterate(b, w, begin, t, h, close) -> bool, with the rung that begins there.

    It finds the laws' inputs of the step from t [s] on, of length h [s], from those in `at.u`, and
    writes rows of arguments; False if the iteration does not end.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, laws = equations.owner, equations.laws
    degree, count, values, channels = form.degree, form.degree + 1, form.values, form.channels
    unknowns, tangents = len(form.stiff), len(form.directions)
    places, size, sharp = form.nodes, len(form.stiff) * form.degree, sharp_directions(form)
    table_of, nodes_of, room_of = array_kernels(form, at, owner)
    stiff = np.array(form.stiff)

    @inner(owner)
    def iterate(b: np.ndarray, w: np.ndarray, begin: int, t: float, h: float, close: float) -> bool:
        table, nodes, room = table_of(w), nodes_of(w), room_of(w)
        u, v = matrix(w, at.u, channels, count), matrix(w, at.v, channels, count)
        chosen = integers(w, at.chosen, channels * count)
        of_inputs = matrix(w, begin + at.of_inputs, channels * count, at.width)
        along = matrix(w, begin + at.along, size, degree * tangents)
        free, rows = w[at.free : at.free + at.width], w[at.wanted : at.wanted + at.width]
        for _ in range(_ITERATIONS):
            copy(free, rows)
            given = inputs(places, table.least, u, 0, values, v, chosen)
            add_chosen(of_inputs, w[at.v :], chosen, given, rows)
            spread(sharp, nodes, rows)
            for i in range(degree):
                laws(b, t + h * places[i + 1], nodes.z[i], nodes.f[i], nodes.k[i], nodes.e[i + 1])
            off = residuals(table, nodes, u, room.r)
            if not off < np.inf:
                return False
            correct(table, nodes, along, room)
            for s in range(unknowns):
                own, by = u[stiff[s], 1:], room.r[s * degree : (s + 1) * degree]
                for i in range(degree):
                    own[i] += by[i]
            if off <= close:
                return True
        return False

    return iterate


def doubts(form: Form, at: WorkPlaces, owner: str) -> tuple[Callable, Callable]:
    """Compile bends(w, changes) -> float and rough(w) -> float, of a step that is solved."""
    degree, count, kinks, values = form.degree, form.degree + 1, form.kinks, form.values
    stiff, signals, nodes = np.array(form.stiff), form.signals, form.nodes
    top, unknowns = form.fit[-1], len(form.stiff)
    top_size, between = np.abs(top).sum(), form.between

    @outside(owner)
    def bends(w: np.ndarray, changes: int) -> float:
        """Share of the step in which no indicator has changed its sign; 1: none does.

        So many changes are looked at: the indicators' number for each node after the start; of all
        of them also changes between two nodes, see `hidden`.
        """
        for k in range(changes):
            if w[at.e + k] * w[at.e + kinks + k] < 0.0:
                return float(nodes[k // kinks])
        straight = 1.0
        if changes == degree * kinks:
            e = matrix(w, at.e, count, kinks)
            for j in range(kinks):
                after = hidden(e, j, between)
                if after >= 0:
                    straight = min(straight, float(nodes[after]))
        return straight

    @inner(owner)
    def highest(w: np.ndarray, channel: int, scale: float) -> float:
        """Highest power of a channel over a step, over its size, which is at least `scale`."""
        own, high = at.u + channel * count, 0.0
        for i in range(count):
            high += top[i] * w[own + i]
            scale = max(scale, abs(w[own + i]))
        return abs(high) / (top_size * scale)

    @inner(owner)
    def rough(w: np.ndarray) -> float:
        """Highest power of the stiff values, and of the signals, over a step, over their size."""
        worst = 0.0
        for s in range(unknowns):
            scale = _TINY
            for i in range(degree):
                scale = max(scale, abs(w[at.f + i * values + int(stiff[s])]))
            worst = max(worst, highest(w, int(stiff[s]), scale))
        for k in range(signals):
            worst = max(worst, highest(w, values + k, _TINY))
        return worst

    return bends, rough


def advancing(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile advance(w, begin, rung): the coordinates at the end of a step that is solved."""
    degree, count, channels, kinks = form.degree, form.degree + 1, form.channels, form.kinks
    arguments, rows, places = form.arguments, form.rows, form.nodes

    @inner(owner)
    def advance(w: np.ndarray, begin: int, rung: int) -> None:
        modes, rotations = int(w[at.modes]), int(w[at.rotations])
        q = w[at.q : at.q + 2 * modes + rotations]
        for r in range(rotations):
            q[2 * modes + r] += w[at.free + rows + r]
        real = w[begin + at.turn : begin + at.turn + modes]
        turn(real, w[begin + at.turn + modes : begin + at.turn + 2 * modes], q)
        size, chosen = channels * count, integers(w, at.chosen, channels * count)
        u, v = matrix(w, at.u, channels, count), matrix(w, at.v, channels, count)
        least = w[at.least : at.least + channels]
        found = inputs(places, least, u, 0, channels, v, chosen)
        push = matrix(w, begin + at.push, size, at.q_size)
        add_chosen(push, w[at.v :], chosen, found, q)
        copy(w[at.e + degree * kinks : at.e + count * kinks], w[at.e : at.e + kinks])
        end = at.z + degree * arguments
        copy(w[end - arguments : end], w[at.start : at.start + arguments])
        copy(w[at.u : at.u + size], w[at.last : at.last + size])
        w[at.before] = rung

    return advance
