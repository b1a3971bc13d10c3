"""The arrays of a core in its work space, as the kernels of `kernels.condensed` take them."""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner_inlined
from herringbone.kernels.compiling.views import matrix
from herringbone.kernels.condensed.collocation import Nodes, Sharp, Table
from herringbone.kernels.condensed.correction import Room
from herringbone.kernels.condensed.in_block.form import Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces


def sharp_directions(form: Form) -> Sharp:
    """Of a form."""
    return Sharp.of(form.nodes, form.sharp)


def _fixed_table(form: Form) -> Table:
    """What depends on the form alone; scale and least lie in the work space."""
    tangent = np.zeros((form.values, form.arguments))
    tangent[list(form.stiff)] = form.tangent
    owners = [form.stiff[k] for k in form.of_tangent]
    return Table.of(tangent, owners, form.mean, form.stiff, form.channels)


def array_kernels(form: Form, at: WorkPlaces, owner: str) -> tuple[Callable, Callable, Callable]:
    """Kernels that find the arrays of a step: tables(w), nodes(w) and corrections(w)."""
    fixed, inner, unknowns = _fixed_table(form), form.degree, len(form.stiff)
    tangents, size = len(form.directions), unknowns * form.degree
    values, arguments, kinks, channels = form.values, form.arguments, form.kinks, form.channels

    @inner_inlined(owner)
    def table(w: np.ndarray) -> Table:
        return Table(
            fixed.first,
            fixed.argument,
            fixed.tangent,
            fixed.value,
            fixed.mean,
            fixed.unknown,
            w[at.scale : at.scale + values],
            w[at.least : at.least + channels],
        )

    @inner_inlined(owner)
    def nodes(w: np.ndarray) -> Nodes:
        return Nodes(
            matrix(w, at.z, inner, arguments),
            matrix(w, at.f, inner, values),
            matrix(w, at.k, inner, tangents),
            matrix(w, at.e, inner + 1, kinks),
            w[at.start : at.start + arguments],
        )

    @inner_inlined(owner)
    def room(w: np.ndarray) -> Room:
        return Room(
            matrix(w, at.matrix, size, size),
            w[at.r : at.r + size],
            w[at.swept : at.swept + size],
            w[at.miss : at.miss + unknowns],
            w[at.answers : at.answers + inner * tangents],
        )

    return table, nodes, room
