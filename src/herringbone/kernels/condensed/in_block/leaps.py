"""Steps of the condensed core in a component's block, as far as its laws bend nowhere."""

import math
from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.compiling.views import integers, matrix
from herringbone.kernels.condensed.channels import inputs
from herringbone.kernels.condensed.in_block.collocated import advancing, doubts, iteration
from herringbone.kernels.condensed.in_block.condense import FOUND, condenser
from herringbone.kernels.condensed.in_block.coordinates import coordinate_kernels
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces
from herringbone.kernels.condensed.in_block.shown import shower
from herringbone.kernels.condensed.modal import add_chosen, add_product

_CLOSE = 10.0
"""Residual of the laws' values, over their size and the tolerance, whose correction solves a step.

A correction makes it a thousand times smaller, or more."""
_SHARE = 0.88
"""Of a tolerance: a step may have the length h with h^4 w = _SHARE tolerance T^3, where w is the
fastest rate and T the period of the laws.

At the knots of their tables they bend in a way of which a polynomial misses a share (h / T)^3, over
a step; that moves what is faster than a step, and the more, the longer it is. Measured errors of
rigs are 0.001 to 1.3 of the tolerance (`campaigns.condensed_steps`)."""
_SAME = 1e-9
"""Relative difference of lengths that are one: rounding of times."""


def step_beginner(
    form: Form, at: WorkPlaces, equations: Equations, set_inputs: Callable
) -> Callable:
    """Compile begin_step(b, w, begin, rung, t, length, c, dc, order).

    It writes the channels of the step from t [s] on, the laws' as they are expected, and what does
    not depend on these. The step lies between c and c + dc of the macro step.
    """
    owner, given, signals = equations.owner, equations.inputs, equations.signals
    values, channels = form.values, form.channels
    count, ahead, nodes, lengths = form.degree + 1, form.ahead, form.nodes, np.array(form.lengths)
    signal_count, first_input, input_count = form.signals, values + form.signals, form.inputs

    @inner(owner)
    def expect(w: np.ndarray, share: float) -> None:
        """Write the laws' values of a step, a share of the last one's length; 0: constant."""
        for value in range(values):
            own, to = w[at.last + value * count :], w[at.u + value * count :]
            end, slope, bend = own[count - 1], 0.0, 0.0
            for i in range(count - 1):
                slope += ahead[0, i] * (own[i] - end)
                bend += ahead[1, i] * (own[i] - end)
            for i in range(count):
                c = share * nodes[i]
                to[i] = end + c * (slope + c * bend)

    @inner(owner)
    def begin_step(
        b: np.ndarray, w: np.ndarray, begin: int, rung: int, t: float, length: float, c: float,
        dc: float, order: int,
    ) -> None:  # fmt: skip
        size, before, now = channels * count, int(w[at.before]), w[at.now :]
        u, v = matrix(w, at.u, channels, count), matrix(w, at.v, channels, count)
        chosen = integers(w, at.chosen, size)
        expect(w, lengths[rung] / lengths[before] if before >= 0 else 0.0)
        for i in range(count):
            set_inputs(b, w, order, c + nodes[i] * dc)
            for k in range(input_count):
                u[first_input + k, i] = b[given[k]]
            signals(b, t + nodes[i] * length, now[:signal_count])
            for k in range(signal_count):
                u[values + k, i] = now[k]
            u[channels - 1, i] = 1.0
        free = w[at.free : at.free + at.width]
        for row in range(at.width):
            free[row] = 0.0
        modes, rotations = int(w[at.modes]), int(w[at.rotations])
        used = 2 * modes + rotations
        of_state = matrix(w, begin + at.of_state, used, at.width)
        add_product(of_state, w[at.q : at.q + used], free)
        for r in range(rotations):
            angle, own = b[int(w[at.references + r])], of_state[2 * modes + r]
            for row in range(at.width):
                free[row] += own[row] * angle
        least = w[at.least : at.least + channels]
        found = inputs(nodes, least, u, values, channels, v, chosen)
        of_inputs = matrix(w, begin + at.of_inputs, size, at.width)
        add_chosen(of_inputs, w[at.v :], chosen, found, free)

    return begin_step


def readier(form: Form, at: WorkPlaces, equations: Equations) -> Callable:
    """Compile ready(b, w, t) -> bool: seeks the condensed form, once; True if there is one."""
    condense = condenser(form, at, equations)
    _, _, belongs, _, forget = coordinate_kernels(form, at, equations)

    @inner(equations.owner)
    def ready(b: np.ndarray, w: np.ndarray, t: float) -> bool:
        if w[at.status] == 0.0:
            condense(b, w, t)
            if w[at.status] != FOUND or not belongs(b, w):
                forget(b, w)
        return w[at.status] == FOUND

    return ready


def leaper(
    form: Form, at: WorkPlaces, equations: Equations, ready: Callable, set_inputs: Callable
) -> tuple[Callable, Callable, Callable, Callable]:
    """Compile the leaps of a component.

    Returns:
        leap(b, w, t, h, begin, end, tolerance, order) -> float: from t + begin towards t + end
        inside of a macro step of length h [s]; time since t that it has reached. It leaves what is
        shorter than the shortest step, and stops where in the shortest step a law bends or its
        values are rough, and where the iteration does not end.
        ready(b, w, t) -> bool: as given, see `readier`.
        forget(b, w): the states are to be others than it left.
        show(b, w, t, how) -> bool: see `shown.shower`.
    """
    owner, prepare, period = equations.owner, equations.prepare, equations.period
    enter, leave, _, settle, forget = coordinate_kernels(form, at, equations)
    begin_step = step_beginner(form, at, equations, set_inputs)
    iterate, advance = iteration(form, at, equations), advancing(form, at, owner)
    bends, rough = doubts(form, at, owner)
    lengths, rungs, roughest = np.array(form.lengths), len(form.lengths), form.rough
    shortest = float(lengths[-1])

    @inner(owner)
    def choose(most: float, left: float) -> int:
        """The longest rung up to a length, or one of half of it that divides what is left; -1."""
        longest = -1
        for rung in range(rungs):
            length = lengths[rung]
            if length > most * (1.0 + _SAME):
                continue
            if longest < 0:
                longest = rung
            count = left / length
            if abs(count - math.floor(count + 0.5)) <= _SAME * count:
                return rung
            if length < 0.5 * most:
                break
        return longest

    @inner(owner)
    def leap(
        b: np.ndarray, w: np.ndarray, t: float, h: float, begin: float, end: float,
        tolerance: float, order: int,
    ) -> float:  # fmt: skip
        done = begin
        if w[at.status] != FOUND:
            return done
        repeat = period(b)
        longest = math.sqrt(math.sqrt(_SHARE * tolerance * repeat / w[at.fastest]) * repeat)
        longest = min(lengths[0], longest)
        if end - done < shortest * (1.0 - _SAME) or longest < shortest:
            return done
        prepare(b)
        enter(b, w, t + done, _CLOSE * tolerance)
        while True:
            rung = choose(min(longest, end - done), end - done)
            if rung < 0:
                break
            length = lengths[rung]
            place = at.rungs + rung * at.rung_size
            begin_step(b, w, place, rung, t + done, length, done / h, length / h, order)
            if not iterate(b, w, place, t + done, length, _CLOSE * tolerance):
                break
            straight = bends(w)
            if straight < 1.0:
                longest = straight * length
                continue
            if rough(w) > roughest * tolerance:
                longest = 0.5 * length
                continue
            advance(w, place, rung)
            done += length
        if done > begin:
            leave(b, w)
        return end if end - done < shortest * _SAME else done

    return leap, ready, forget, shower(form, at, equations, settle)
