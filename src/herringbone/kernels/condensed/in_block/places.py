"""Where the condensed core of a component keeps what it needs in the work space."""

from itertools import accumulate
from typing import NamedTuple

from herringbone.kernels.condensed.in_block.form import Form
from herringbone.kernels.eigen.vectors import room

_SPARE = 16
"""Modes that are not oscillations, at most twice as many, for which there is room."""
_SCRATCH = 64


class WorkPlaces(NamedTuple):
    """Places in the work space, in reals; those of a rung from its begin on.

    Attributes:
        q_rows, of_inputs, push, turn, angle, along: of a rung: what is wanted at the nodes, of the
            coordinates and of the inputs; what the inputs add to the coordinates and the angle;
            factors of the coordinates; growth of the angle by them; directions of the tangents
            over the unknowns.
        rung_size: length of a rung.
        status: 1 where there are matrices, -1 where there is no condensed form, 0 at first.
        modes, inside: numbers of modes, and of states that move besides the turning one.
        states: which states these are.
        rates, turns: eigenvalues, and what the angle grows by, real and imaginary parts.
        of_angle: (arguments,) of the angle.
        carg: (2, arguments, capacity), arguments of the modes.
        bq: (2, channels, capacity), inputs of the modes.
        shapes, back: see `kernels.eigen.vectors`; when all is found, by columns over coordinates.
        room: for a node of a mode.
        x: (states,).
        z: (arguments,).
        q: coordinates, then growth of the angle.
        u: (channels, nodes) of the step; `v` as differences from the first node, see `rung`; those
            of the laws in the last step are in `last`.
        free, at_nodes: arguments at the nodes but the first, without the laws, and with them.
        f, k, e: what the laws give there; e at the first node, too.
        matrix, r: of the correction.
        rungs: the first rung.
        end: behind everything.
        capacity: room for modes.
        q_size: room for coordinates, all real parts, then all imaginary parts, and for the angle.
        rows: (nodes - 1) x arguments.
    """

    q_rows: int
    of_inputs: int
    push: int
    turn: int
    angle: int
    along: int
    rung_size: int
    status: int
    modes: int
    inside: int
    states: int
    rates: int
    turns: int
    of_angle: int
    carg: int
    bq: int
    shapes: int
    back: int
    room: int
    x: int
    z: int
    q: int
    u: int
    v: int
    last: int
    free: int
    at_nodes: int
    f: int
    k: int
    e: int
    matrix: int
    r: int
    rungs: int
    end: int
    capacity: int
    q_size: int
    rows: int


class Taken(NamedTuple):
    """Places of what is taken from the kernels, where the rungs are to be; n states.

    Attributes:
        whole: (n, n) of the states, with mean tangents.
        of_inputs: (n, channels).
        of_states: (arguments, n).
        rates: (4, n).
        matrix: (n, n).
        room: of the eigenvalues.
        end: behind everything.
    """

    whole: int
    of_inputs: int
    of_states: int
    rates: int
    matrix: int
    room: int
    end: int


def taken_places(form: Form, first: int) -> Taken:
    """Places from `first` on."""
    n = form.states
    sizes = (n * n, n * form.channels, n * form.arguments, 4 * n, n * n, room(n))
    return Taken(*accumulate(sizes, initial=first))


def work_places(form: Form, first: int) -> WorkPlaces:
    """Places from `first` on."""
    n, channels, degree, arguments = form.states, form.channels, form.degree, form.arguments
    q_size, rows = n + _SPARE, degree * arguments
    capacity, given = q_size // 2, channels * (degree + 1)
    tangents, unknowns = len(form.directions), len(form.stiff) * degree
    matrices = (
        q_size * rows, given * rows, given * q_size, 2 * capacity, q_size,
        degree * tangents * unknowns,
    )  # fmt: skip
    arrays = (
        1, 1, 1, n, 2 * capacity, 2 * capacity, arguments, 2 * arguments * capacity,
        2 * channels * capacity, n * q_size, n * q_size, _SCRATCH, n, arguments, q_size + 1,
        given, given, given, rows, rows, degree * form.values, degree * tangents,
        (degree + 1) * form.kinks, unknowns * unknowns, unknowns,
    )  # fmt: skip
    rung, own = list(accumulate(matrices, initial=0)), list(accumulate(arrays, initial=first))
    end = max(own[-1] + len(form.lengths) * rung[-1], taken_places(form, own[-1]).end)
    return WorkPlaces._make((*rung, *own, end, capacity, q_size, rows))
