"""Steps of the condensed core in a component's block, as far as its laws bend nowhere."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inner, outside
from herringbone.kernels.compiling.views import integers, matrix
from herringbone.kernels.condensed.channels import inputs
from herringbone.kernels.condensed.in_block.collocated import advancing, doubts, iteration
from herringbone.kernels.condensed.in_block.condensing.condense import FOUND, condenser
from herringbone.kernels.condensed.in_block.coordinates import enterer
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces
from herringbone.kernels.condensed.in_block.shown import ShowKernels, show_kernels, shower
from herringbone.kernels.condensed.in_block.states import StateKernels, state_kernels
from herringbone.kernels.condensed.modal import add_chosen, add_product
from herringbone.kernels.stepping.leaping import SAME, Leaps

_CLOSE = 10.0
"""Residual of the laws' values, over their size and the tolerance, whose correction solves a step.

A correction makes it a thousand times smaller, or more."""
_SHARE = 0.88
"""Of a tolerance: a step may have the length h with h^4 w = _SHARE tolerance T^3, where w is the
fastest rate and T the period of the laws.

At the knots of their tables they bend in a way of which a polynomial misses a share (h / T)^3, over
a step; that moves what is faster than a step, and the more, the longer it is. Measured errors of
rigs are 0.001 to 1.3 of the tolerance (`campaigns.condensed_steps`)."""


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


class Core(NamedTuple):
    """Kernels of the condensed core of a component, each compiled once for all its steps.

    Attributes:
        ready: (b, w, t) -> bool: seeks the condensed form, once; True if there is one.
        enter: see `coordinates.enterer`.
        states: from coordinates to states.
        shown: outputs straight from the coordinates, if there are some.
    """

    ready: Callable
    enter: Callable
    states: StateKernels
    shown: ShowKernels


def core_kernels(form: Form, at: WorkPlaces, equations: Equations) -> Core:
    """Compile what all steps of a component share.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    condense, states = condenser(form, at, equations), state_kernels(form, at, equations)
    belongs, forget = states.belongs, states.forget

    @inner(equations.owner)
    def ready(b: np.ndarray, w: np.ndarray, t: float) -> bool:
        if w[at.status] == 0.0:
            condense(b, w, t)
            if w[at.status] != FOUND or not belongs(b, w):
                forget(b, w)
        return w[at.status] == FOUND

    enter, shown = enterer(form, at, equations), show_kernels(form, at, equations)
    return Core(ready, enter, states, shown)


def _chooser(form: Form, owner: str) -> Callable:
    """Compile choose(most, left) -> int."""
    lengths, rungs = np.array(form.lengths), len(form.lengths)

    @inner(owner)
    def choose(most: float, left: float) -> int:
        """The longest rung up to a length, or one of half of it that divides what is left; -1."""
        longest = -1
        for rung in range(rungs):
            length = lengths[rung]
            if length > most * (1.0 + SAME):
                continue
            if longest < 0:
                longest = rung
            count = left / length
            if abs(count - math.floor(count + 0.5)) <= SAME * count:
                return rung
            if length < 0.5 * most:
                break
        return longest

    return choose


def leaper(
    form: Form, at: WorkPlaces, equations: Equations, core: Core, set_inputs: Callable
) -> Leaps:
    """Compile the leaps of a component.

    They leave what is shorter than the shortest step, and stop where in the shortest step a law
    bends or its values are rough, and where the iteration does not end.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
        core: of the component.
        set_inputs: see `steppers.input_kernels`.
    """
    owner, prepare, period = equations.owner, equations.prepare, equations.period
    enter, leave, choose = core.enter, core.states.leave, _chooser(form, owner)
    begin_step = step_beginner(form, at, equations, set_inputs)
    iterate, advance = iteration(form, at, equations), advancing(form, at, owner)
    bends, rough = doubts(form, at, owner)
    changes = form.degree * form.kinks
    lengths, roughest, shortest = np.array(form.lengths), form.rough, float(form.lengths[-1])

    @inner(owner)
    def leap(
        b: np.ndarray, w: np.ndarray, t: float, h: float, begin: float, end: float,
        tolerance: float, order: int,
    ) -> float:  # fmt: skip
        done, repeat = begin, period(b)
        longest = math.sqrt(math.sqrt(_SHARE * tolerance * repeat / w[at.fastest]) * repeat)
        longest = min(lengths[0], longest)
        if end - done < shortest * (1.0 - SAME) or longest < shortest:
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
            straight = bends(w, changes)
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
        return end if end - done < shortest * SAME else done

    show = shower(form, at, equations, core.states.settle, core.shown.everything)
    bent = _bend_finder(form, at, equations, bends)
    return Leaps(leap, core.ready, bent, core.states.forget, show)


def _bend_finder(form: Form, at: WorkPlaces, equations: Equations, bends: Callable) -> Callable:
    """Compile bent(b, w, t, row) -> bool, see `Leaps`."""
    kinks, indicators = form.kinks, equations.indicators

    @outside(equations.owner)
    def bent(b: np.ndarray, w: np.ndarray, t: float, row: int) -> bool:
        indicators(b, t, w[at.z :], w[at.f :], w[at.k :], w[at.e + row * kinks :])
        return bends(w, kinks) < 1.0

    return bent
