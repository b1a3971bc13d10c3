"""Where the condensed core of a component keeps what it needs in the work space."""

from itertools import accumulate
from typing import NamedTuple

import numpy as np

from herringbone.kernels.condensed.in_block.form import Form, Shown
from herringbone.kernels.condensed.lines import padded
from herringbone.kernels.eigen.vectors import room
from herringbone.kernels.signals import STRIDE

_SPARE = 16
"""Modes that are not oscillations, at most twice as many, for which there is room."""
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
        full: (q_size, (nodes - 1) x arguments): arguments at all nodes, of the coordinates, while
            a rung is made.
        full_inputs: (channels x nodes, (nodes - 1) x arguments): the same of the inputs.
        seen: (2 modes + rotations + channels, states inside and outputs, in whole lines), see
            `in_block.condensing.seen`.
        bent: (outputs,) 1 where one is not affine.
        asked: (outputs and states,) rows of `seen` that were asked for, in this order.
        known: (outputs and states,) 1 for these.
        need: (parts,) 1 where a part makes some of them.
        asking: how many rows these are.
        showing: 1 if outputs can be shown.
        packed: these rows of `seen`, in whole lines.
        values: (states and outputs,) of them.
        inside_of: (states,) which of the states inside each one is, or -1.
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
    full_inputs: int
    seen: int
    bent: int
    asked: int
    known: int
    need: int
    asking: int
    showing: int
    packed: int
    values: int
    inside_of: int
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
        whole: (n + outputs, n) of the states, with mean tangents.
        of_inputs: (n + outputs, channels).
        of_states: (arguments, n).
        rates: (4, n + outputs).
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
    n, rows = form.states, form.states + form.outputs
    sizes = (
        rows * n, rows * form.channels, n * form.arguments, 4 * rows, n * n,
        room(n) + form.inputs,
    )  # fmt: skip
    return Taken(*accumulate(sizes, initial=first))


def _state_sizes(form: Form) -> tuple[int, ...]:
    """Of what a core goes on with, from `q` on."""
    channels, angles = form.channels, len(form.turning)
    given = channels * (form.degree + 1)
    return (
        padded(form.states + _SPARE + angles), given, form.values, channels, 1, form.arguments,
        (form.degree + 1) * form.kinks,
    )  # fmt: skip


def output_places(shown: Shown) -> np.ndarray:
    """Of the outputs that are shown, in the block; one more, as a kernel has no empty arrays."""
    with_nodes = shown.first + STRIDE * np.arange(shown.with_nodes)
    others = shown.first + STRIDE * shown.with_nodes
    count = len(shown.part) - shown.with_nodes
    return np.concatenate([with_nodes, others + np.arange(count), [0]])


def kept_size(form: Form) -> int:
    """How many reals a core goes on with, see `states.STALE`, `states.HOLDS`."""
    return 2 + sum(_state_sizes(form))


def _shown_sizes(form: Form, q_size: int) -> tuple[int, ...]:
    """From `seen` to `inside_of`."""
    if not form.outputs:
        return (0,) * 10
    rows = form.states + form.outputs
    matrix = (q_size + form.channels) * padded(rows)
    parts = len(form.shown.states)
    return matrix, form.outputs, rows, rows, parts, 1, 1, matrix, padded(rows), form.states


def work_places(form: Form, first: int) -> WorkPlaces:
    """Places from `first` on."""
    n, channels, degree, arguments = form.states, form.channels, form.degree, form.arguments
    angles, stiff, tangents = len(form.turning), len(form.stiff), len(form.directions)
    capacity, given, unknowns = (n + _SPARE) // 2, channels * (degree + 1), stiff * degree
    of_state = _state_sizes(form)
    q_size, width = of_state[0], padded(form.rows + angles)
    matrices = (
        2 * capacity, q_size * width, given * width, given * q_size, unknowns * degree * tangents,
    )  # fmt: skip
    arrays = (
        1, 1, 1, 1, 1, n, angles, angles * n, 2 * capacity, 2 * angles * capacity,
        angles * arguments, arguments * channels, 2 * arguments * capacity,
        2 * channels * capacity, n * (n + _SPARE), n * (n + _SPARE), _SCRATCH,
        q_size * degree * arguments, given * degree * arguments, *_shown_sizes(form, q_size),
        n, channels, *of_state, given, given, given, width, width, degree * arguments,
        degree * form.values, degree * tangents, unknowns * unknowns, unknowns, unknowns, stiff,
        degree * tangents,
    )  # fmt: skip
    rung, own = list(accumulate(matrices, initial=0)), list(accumulate(arrays, initial=first))
    end = max(own[-1] + len(form.lengths) * rung[-1], taken_places(form, own[-1]).end)
    return WorkPlaces._make((*rung, *own, end, capacity, q_size, width))
