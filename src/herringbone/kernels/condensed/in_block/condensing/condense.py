"""The condensed form of a component in its block, found when its parameters are known."""

import math
from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.condensing.apart import apart_taker
from herringbone.kernels.condensed.in_block.condensing.check import checker
from herringbone.kernels.condensed.in_block.condensing.in_modes import mode_arranger, mode_finder
from herringbone.kernels.condensed.in_block.condensing.rung import rung_maker
from herringbone.kernels.condensed.in_block.condensing.seen import seen_arranger
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces

FOUND, NONE = 1, -1
"""Status: there is a condensed form, or none."""


def condenser(
    form: Form, at: WorkPlaces, equations: Equations
) -> Callable[[np.ndarray, np.ndarray, float], None]:
    """Compile condense(b, w, t): writes the form and the matrices of steps, or that there is none.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    capacity = at.capacity
    owner, lengths, rungs = equations.owner, np.array(form.lengths), len(form.lengths)
    apart, holds = apart_taker(form, at, equations), checker(form, at, equations)
    find, arrange = mode_finder(form, at, owner), mode_arranger(at, owner)
    make = rung_maker(form, at, owner)
    arrange_seen, outputs = seen_arranger(form, at, owner), form.outputs

    @outside(owner)
    def fastest(w: np.ndarray) -> float:
        found = 0.0
        for mode in range(int(w[at.modes])):
            real, imag = w[at.rates + mode], w[at.rates + capacity + mode]
            found = max(found, math.sqrt(real * real + imag * imag))
        return found

    @outside(owner)
    def condense(b: np.ndarray, w: np.ndarray, t: float) -> None:
        w[at.status] = NONE
        if not apart(b, w) or not find(w) or not holds(b, w, t):
            return
        if outputs > 0:
            arrange_seen(w)
        arrange(w)
        w[at.fastest] = fastest(w)
        for rung in range(rungs):
            make(w, rung, lengths[rung])
        w[at.status] = FOUND

    return condense
