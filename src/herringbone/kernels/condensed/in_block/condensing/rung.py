"""Matrices of one step of modal coordinates under channels that are polynomials over it.

They are those of `analysis.twin.condensed.rungs`, in the kernel language.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.condensing.of_mode import (
    channel_adder,
    start_adder,
    weight_writer,
)
from herringbone.kernels.condensed.in_block.form import Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces


def rung_maker(form: Form, at: WorkPlaces, owner: str) -> Callable[[np.ndarray, int, float], None]:
    """Compile make(w, rung, h): writes the matrices of steps of a length [s]."""
    nodes, degree, channels = form.nodes, form.degree, form.channels
    count, whole, angles = degree + 1, degree * form.arguments, len(form.turning)
    weights = weight_writer(form, at, owner)
    of_start, of_channel = start_adder(form, at, owner), channel_adder(form, at, owner)
    direct, slopes = _direct_adder(form, at, owner), _slope_writer(form, at, owner)
    as_inputs, wanted = _input_former(form, owner), _row_writer(form, at, owner)

    @outside(owner)
    def make(w: np.ndarray, rung: int, h: float) -> None:
        begin = at.rungs + rung * at.rung_size
        for k in range(at.rung_size):
            w[begin + k] = 0.0
        for k in range((at.q_size + channels * count) * whole):
            w[at.full + k] = 0.0
        for i in range(degree):
            for mode in range(int(w[at.modes])):
                weights(w, mode, nodes[i + 1], h)
                of_start(w, begin, mode, i)
                for channel in range(channels):
                    of_channel(w, begin, mode, i, channel)
        direct(w)
        slopes(w, begin)
        as_inputs(w, at.full_inputs, whole)
        as_inputs(w, begin + at.push, at.q_size)
        wanted(w, at.full, begin + at.of_state, 2 * int(w[at.modes]) + angles)
        wanted(w, at.full_inputs, begin + at.of_inputs, channels * count)

    return make


def _direct_adder(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile direct(w)."""
    degree, arguments, channels, values = form.degree, form.arguments, form.channels, form.values
    count, whole = degree + 1, degree * arguments

    @outside(owner)
    def direct(w: np.ndarray) -> None:
        """Add what signals, inputs and the 1 do to arguments at once, and angles."""
        for channel in range(values, channels):
            for i in range(degree):
                to = at.full_inputs + (channel * count + i + 1) * whole + i * arguments
                for k in range(arguments):
                    w[to + k] += w[at.of_channels + k * channels + channel]
        for r in range(int(w[at.rotations])):
            to = at.full + (2 * int(w[at.modes]) + r) * whole
            for i in range(degree):
                for k in range(arguments):
                    w[to + i * arguments + k] = w[at.of_angles + r * arguments + k]

    return direct


def _slope_writer(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile slopes(w, begin), for the rung that begins there."""
    degree, arguments = form.degree, form.arguments
    count, whole = degree + 1, degree * arguments
    directions, stiff = form.directions.ravel(), np.array(form.stiff)
    tangents, unknowns = len(form.directions), len(form.stiff)

    @outside(owner)
    def slopes(w: np.ndarray, begin: int) -> None:
        """Write directions of the tangents over the unknowns."""
        for s in range(unknowns):
            for n in range(degree):
                given = at.full_inputs + (int(stiff[s]) * count + n + 1) * whole
                to = begin + at.along + (s * degree + n) * degree * tangents
                for i in range(degree):
                    for tangent in range(tangents):
                        total = 0.0
                        for k in range(arguments):
                            total += (
                                directions[tangent * arguments + k] * w[given + i * arguments + k]
                            )
                        w[to + i * tangents + tangent] = total

    return slopes


def _input_former(form: Form, owner: str) -> Callable:
    """Compile as_inputs(w, first, size), of rows of that size from `first` on."""
    nodes, degree, count, channels = form.nodes, form.degree, form.degree + 1, form.channels

    @outside(owner)
    def as_inputs(w: np.ndarray, first: int, size: int) -> None:
        """From values at the nodes to inputs, see `channels.inputs`."""
        for channel in range(channels):
            to = first + channel * count * size
            end = to + degree * size
            for k in range(size):
                for n in range(1, count):
                    w[to + k] += w[to + n * size + k]
                for n in range(1, degree):
                    w[end + k] += nodes[n] * w[to + n * size + k]

    return as_inputs


def _row_writer(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile wanted(w, first, to, count), of so many rows from `first` on."""
    degree, arguments, whole = form.degree, form.arguments, form.degree * form.arguments
    sharp, sharp_count = form.sharp.ravel(), len(form.sharp)

    @outside(owner)
    def wanted(w: np.ndarray, first: int, to: int, count: int) -> None:
        """Write, of rows over all nodes, what is wanted in a step."""
        for row in range(count):
            own, target = first + row * whole, to + row * at.width
            for i in range(degree - 1):
                for s in range(sharp_count):
                    total = 0.0
                    for k in range(arguments):
                        total += sharp[s * arguments + k] * w[own + i * arguments + k]
                    w[target + i * sharp_count + s] = total
            for k in range(arguments):
                w[target + (degree - 1) * sharp_count + k] = w[own + whole - arguments + k]

    return wanted
