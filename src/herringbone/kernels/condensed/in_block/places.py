"""Where the condensed core of a component keeps what it needs in the work space."""

from itertools import accumulate
from typing import NamedTuple

from herringbone.kernels.condensed.in_block.form import Form
from herringbone.kernels.eigen.vectors import room

_SPARE = 16
"""Modes that are not oscillations, at most twice as many, for which there is room."""
_LINE = 8
_SCRATCH = 64


class WorkPlaces(NamedTuple):
    """Places in the work space, in reals; those of a rung from its begin on.

    Attributes:
        turn: (2, modes) of a rung: factors of the coordinates.
        of_state: (q_size, width): what is wanted in a step (`Form.rows`, then growth of angles), of
            the coordinates.
        of_inputs: (channels x nodes, width): the same of the inputs, see `channels.inputs`.
        push: (channels x nodes, q_size): coordinates at the end of the inputs.
        along: (unknowns x (nodes - 1), (nodes - 1) x tangents), see `correction.correct`.
        rung_size: length of a rung.
        status: 1 where there are matrices, -1 where there is no condensed form, 0 at first.
        fastest: size of the largest eigenvalue [1/s].
        modes, inside, rotations: numbers of modes, of states that move besides those whose angles
            are kept apart, and of these.
        states, references: which states these are.
        rigid: (turning, states): by rotation, the states that grow with its angle.
        rates: eigenvalues, real and imaginary parts, (2, capacity).
        turns: (turning, 2, capacity), what the angles grow by.
        of_angles: (turning, arguments).
        of_channels: (arguments, channels).
        carg: (2, arguments, capacity), arguments of the modes.
        bq: (2, channels, capacity), inputs of the modes.
        shapes, back: see `kernels.eigen.vectors`; when all is found, by columns over coordinates.
        room: for a node of a mode.
        full: (q_size + channels x nodes, (nodes - 1) x arguments), while a rung is made.
        x: (states,).
        now: (channels,) at a time.
        q: real parts of the coordinates, imaginary parts, growth of the angles, zeros.
        last: (channels, nodes) of the last step.
        scale, least: see `collocation.Table`.
        before: rung of the last step, -1: its values are not to be continued.
        start, e: see `collocation.Nodes`; from `q` on this is what a core goes on with.
        u, v: (channels, nodes) of the step, as values and as inputs.
        chosen: (channels x nodes,) integers.
        free, wanted: (width,) without the laws' inputs, and with them.
        z, f, k: see `collocation.Nodes`.
        matrix, r, swept, miss, answers: see `correction.Room`.
        rungs: the first rung.
        end: behind everything.
        capacity: room for modes.
        q_size: room for coordinates and angles.
        width: `Form.rows` and growth of angles, in whole lines.
    """

    turn: int
    of_state: int
    of_inputs: int
    push: int
    along: int
    rung_size: int
    status: int
    fastest: int
    modes: int
    inside: int
    rotations: int
    states: int
    references: int
    rigid: int
    rates: int
    turns: int
    of_angles: int
    of_channels: int
    carg: int
    bq: int
    shapes: int
    back: int
    room: int
    full: int
    x: int
    now: int
    q: int
    last: int
    scale: int
    least: int
    before: int
    start: int
    e: int
    u: int
    v: int
    chosen: int
    free: int
    wanted: int
    z: int
    f: int
    k: int
    matrix: int
    r: int
    swept: int
    miss: int
    answers: int
    rungs: int
    end: int
    capacity: int
    q_size: int
    width: int


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


def _lines(count: int) -> int:
    """A count of reals that fills whole lines of the cache."""
    return -(-count // _LINE) * _LINE


def taken_places(form: Form, first: int) -> Taken:
    """Places from `first` on."""
    n = form.states
    sizes = (n * n, n * form.channels, n * form.arguments, 4 * n, n * n, room(n))
    return Taken(*accumulate(sizes, initial=first))


def _state_sizes(form: Form) -> tuple[int, ...]:
    """Of what a core goes on with, from `q` on."""
    channels, angles = form.channels, len(form.turning)
    given = channels * (form.degree + 1)
    return (
        _lines(form.states + _SPARE + angles), given, form.values, channels, 1, form.arguments,
        (form.degree + 1) * form.kinks,
    )  # fmt: skip


def kept_size(form: Form) -> int:
    """How many reals a core goes on with: 1 where they hold, and they."""
    return 1 + sum(_state_sizes(form))


def work_places(form: Form, first: int) -> WorkPlaces:
    """Places from `first` on."""
    n, channels, degree, arguments = form.states, form.channels, form.degree, form.arguments
    angles, stiff, tangents = len(form.turning), len(form.stiff), len(form.directions)
    capacity, given, unknowns = (n + _SPARE) // 2, channels * (degree + 1), stiff * degree
    of_state = _state_sizes(form)
    q_size, width = of_state[0], _lines(form.rows + angles)
    matrices = (
        2 * capacity, q_size * width, given * width, given * q_size, unknowns * degree * tangents,
    )  # fmt: skip
    arrays = (
        1, 1, 1, 1, 1, n, angles, angles * n, 2 * capacity, 2 * angles * capacity,
        angles * arguments, arguments * channels, 2 * arguments * capacity,
        2 * channels * capacity, n * (n + _SPARE), n * (n + _SPARE), _SCRATCH,
        (q_size + given) * degree * arguments, n, channels, *of_state, given, given, given, width,
        width, degree * arguments, degree * form.values, degree * tangents, unknowns * unknowns,
        unknowns, unknowns, stiff, degree * tangents,
    )  # fmt: skip
    rung, own = list(accumulate(matrices, initial=0)), list(accumulate(arrays, initial=first))
    end = max(own[-1] + len(form.lengths) * rung[-1], taken_places(form, own[-1]).end)
    return WorkPlaces._make((*rung, *own, end, capacity, q_size, width))
