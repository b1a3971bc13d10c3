"""Steps of the condensed core in a component's block, as far as its laws bend nowhere."""

import math
from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.condensed.in_block.collocated import difference_kernel, doubts, iteration
from herringbone.kernels.condensed.in_block.columns import add_columns
from herringbone.kernels.condensed.in_block.condense import FOUND, condenser
from herringbone.kernels.condensed.in_block.coordinates import coordinate_kernels
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces

_CLOSE = 10.0
"""Residual of the laws' values, over their size and the tolerance, whose correction solves a step.

A correction makes it a thousand times smaller, or more."""
_ROUGH = 5.0
"""Highest power of the laws' values over a step, over their size and the tolerance, at most."""
_PER_PERIOD = 0.055
"""Share of a period of the laws that a step has at most, at the tolerance _USUAL; there the error
of a gearbox is a seventh to a half of it. It falls with the fourth power of the step, or faster."""
_USUAL = 1e-3
_SAME = 1e-9
"""Relative difference of lengths that are one: rounding of times."""


def predictor(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile predict(w, onward): along the polynomials of the last step, or constant."""
    values, ahead = form.values, form.ahead.ravel()
    degree, count = form.degree, form.degree + 1

    @inner(owner)
    def predict(w: np.ndarray, onward: bool) -> None:
        """Write the laws' values of the next step from those of the last one."""
        for value in range(values):
            own = w[at.last + value * count : at.last + (value + 1) * count]
            to = w[at.u + value * count : at.u + (value + 1) * count]
            for i in range(count):
                to[i] = own[degree]
            if onward:
                for m in range(degree):
                    change = own[m] - own[degree]
                    for i in range(1, count):
                        to[i] += ahead[m * count + i] * change

    return predict


def leaper(  # noqa: PLR0915 (kernels that share their layout)
    form: Form, at: WorkPlaces, equations: Equations, set_inputs: Callable
) -> tuple[Callable, Callable]:
    """Compile the leaps of a component.

    Returns:
        leap(b, w, t, h, begin, end, tolerance, order) -> float: from t + begin towards t + end
        inside of a macro step of length h [s]; time since t that it has reached. It leaves what is
        shorter than the shortest step, and stops where a law bends, where the iteration does not
        end, or where the tolerance asks for shorter steps. And ready(b, w, t), which makes what
        leaps need, if it is not there.
    """
    owner, turning, inputs = equations.owner, equations.turning, np.array(equations.inputs)
    prepare, period, condense = equations.prepare, equations.period, condenser(form, at, equations)
    enter, leave, advance = coordinate_kernels(form, at, equations)
    differences, iterate = difference_kernel(form, at, owner), iteration(form, at, equations)
    (bends, rough), predict = doubts(form, at, owner), predictor(form, at, owner)
    values, channels, arguments = form.values, form.channels, form.arguments
    nodes, degree, count, rows = form.nodes, form.degree, form.degree + 1, at.rows
    lengths, rungs, input_count = np.array(form.lengths), len(form.lengths), form.inputs
    shortest = float(lengths[-1])

    @inner(owner)
    def begin_step(
        b: np.ndarray, w: np.ndarray, begin: int, done: float, length: float, h: float, order: int
    ) -> None:
        """Write what does not depend on the laws' values of this step."""
        modes = int(w[at.modes])
        for i in range(count):
            set_inputs(b, w, order, (done + nodes[i] * length) / h)
            for k in range(input_count):
                w[at.u + (values + k) * count + i] = b[inputs[k]]
            w[at.u + (channels - 1) * count + i] = 1.0
        differences(w, values, channels)
        angle = b[turning] + w[at.q + 2 * modes]
        for i in range(degree):
            for a in range(arguments):
                w[at.free + i * arguments + a] = w[at.of_angle + a] * angle
        add_columns(w[begin + at.q_rows :], rows, w[at.q :], 2 * modes, w[at.free :], rows)
        of_inputs = w[begin + at.of_inputs + values * count * rows :]
        add_columns(
            of_inputs,
            rows,
            w[at.v + values * count :],
            (channels - values) * count,
            w[at.free :],
            rows,
        )

    @inner(owner)
    def ready(b: np.ndarray, w: np.ndarray, t: float) -> None:
        if w[at.status] == 0.0:
            condense(b, w, t)

    @inner(owner)
    def leap(
        b: np.ndarray, w: np.ndarray, t: float, h: float, begin: float, end: float,
        tolerance: float, order: int,
    ) -> float:  # fmt: skip
        done = begin
        longest = min(lengths[0], _PER_PERIOD * period(b))
        longest *= math.sqrt(math.sqrt(tolerance / _USUAL))
        if end - done < shortest * (1.0 - _SAME) or longest < shortest:
            return done
        ready(b, w, t)
        if w[at.status] != FOUND:
            return done
        prepare(b)
        enter(b, w)
        rung, before = 0, -1
        while rung < rungs:
            length = lengths[rung]
            if length > longest or end - done < length * (1.0 - _SAME):
                rung += 1
                continue
            place = at.rungs + rung * at.rung_size
            predict(w, before == rung)
            begin_step(b, w, place, done, length, h, order)
            if not iterate(b, w, place, _CLOSE * tolerance) or bends(w):
                break
            if rough(w) > _ROUGH * tolerance:
                break
            differences(w, 0, values)
            advance(w, place)
            done, before = done + length, rung
        leave(b, w)
        return end if end - done < shortest * _SAME else done

    return leap, ready
