"""A component's equations taken apart in its block: a linear rest, as matrices, and laws.

Matrices are taken from its kernels at unit vectors, as `analysis.twin.condensed.equations` does.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.condensing.rotations import rotation_finder
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, taken_places


def apart_taker(
    form: Form, at: WorkPlaces, equations: Equations
) -> Callable[[np.ndarray, np.ndarray], bool]:
    """Compile apart(b, w) -> bool: writes the matrices, and which states move; False if it is none.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    take_apart = _matrix_taker(form, at, equations)
    add_tangents = _tangent_adder(form, at, equations.owner)
    find_rotations = rotation_finder(form, at, equations.owner)
    list_moving = _moving_lister(form, at, equations.owner)

    @outside(equations.owner)
    def apart(b: np.ndarray, w: np.ndarray) -> bool:
        if not take_apart(b, w):
            return False
        add_tangents(w)
        if not find_rotations(w):
            return False
        list_moving(w)
        return True

    return apart


def _matrix_taker(form: Form, at: WorkPlaces, equations: Equations) -> Callable:
    """Compile take_apart(b, w) -> bool: matrices of the rest.

    It is False if laws depend on each other without delay.
    """
    owner, given, values = equations.owner, equations.given, form.values
    n, channels, arguments = form.states, form.channels, form.arguments
    rows, of = n + form.outputs, taken_places(form, at.rungs)

    @outside(owner)
    def answer(b: np.ndarray, w: np.ndarray) -> None:
        """Rates and arguments at the states and channels."""
        z = w[at.start : at.start + arguments]
        given(b, w[at.x : at.x + n], w[at.now :], w[of.rates : of.rates + rows], z)

    @outside(owner)
    def unit(b: np.ndarray, w: np.ndarray, place: int, to: int, to_own: int, width: int) -> float:
        """Write what a unit at a place adds to rates, outputs and arguments; the latter's size."""
        dx, still = w[of.rates : of.rates + rows], w[of.rates + rows : of.rates + 2 * rows]
        w[place] = 1.0
        answer(b, w)
        w[place] = 0.0
        for i in range(rows):
            w[to + i * width] = dx[i] - still[i]
        size = 0.0
        for k in range(arguments):
            own = w[at.start + k] - w[at.of_channels + k * channels + channels - 1]
            w[to_own + k * width] = own
            size += abs(own)
        return size

    @outside(owner)
    def take_apart(b: np.ndarray, w: np.ndarray) -> bool:
        for i in range(n):
            w[at.x + i] = 0.0
        for c in range(channels):
            w[at.now + c] = 0.0
        answer(b, w)
        for i in range(rows):
            still = w[of.rates + i]
            w[of.rates + rows + i] = still
            w[of.of_inputs + i * channels + channels - 1] = still
        for k in range(arguments):
            w[at.of_channels + k * channels + channels - 1] = w[at.start + k]
        direct = 0.0
        for c in range(channels - 1):
            own = unit(b, w, at.now + c, of.of_inputs + c, at.of_channels + c, channels)
            if c < values:
                direct += own
        for j in range(n):
            unit(b, w, at.x + j, of.whole + j, of.of_states + j, n)
        return direct == 0.0

    return take_apart


def _tangent_adder(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile add_tangents(w): adds to the matrices what the laws do by their mean tangents."""
    n, channels, arguments, values = form.states, form.channels, form.arguments, form.values
    rows, of = n + form.outputs, taken_places(form, at.rungs)
    stiff, unknowns, tangent = np.array(form.stiff), len(form.stiff), form.tangent.ravel()

    @outside(owner)
    def add_tangents(w: np.ndarray) -> None:
        for s in range(unknowns):
            for k in range(arguments):
                mean = tangent[s * arguments + k]
                if mean != 0.0:
                    for i in range(rows):
                        first = of.of_inputs + i * channels
                        by = mean * w[first + int(stiff[s])]
                        for j in range(n):
                            w[of.whole + i * n + j] += by * w[of.of_states + k * n + j]
                        for c in range(values, channels):
                            w[first + c] += by * w[at.of_channels + k * channels + c]

    return add_tangents


def _moving_lister(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile list_moving(w): lists the states that move, or stay and are felt.

    Those of the rotations are not among them.
    """
    n, channels, arguments = form.states, form.channels, form.arguments
    rows, of = n + form.outputs, taken_places(form, at.rungs)

    @outside(owner)
    def find_moving(w: np.ndarray) -> None:
        """Find the states that can change: others give them a rate, or inputs do."""
        can, again = w[of.rates : of.rates + n], True
        for i in range(n):
            can[i] = 1.0
        while again:
            again = False
            for i in range(n):
                size = 0.0
                for c in range(channels):
                    size += abs(w[of.of_inputs + i * channels + c])
                for j in range(n):
                    size += can[j] * abs(w[of.whole + i * n + j])
                if can[i] != 0.0 and size == 0.0:
                    can[i], again = 0.0, True

    @outside(owner)
    def is_felt(w: np.ndarray, j: int) -> bool:
        """True if arguments, rates of what moves, or outputs depend on a state."""
        can, felt = w[of.rates : of.rates + n], 0.0
        for k in range(arguments):
            felt += abs(w[of.of_states + k * n + j])
        for i in range(n):
            felt += abs(can[i] * w[of.whole + i * n + j])
        for i in range(n, rows):
            felt += abs(w[of.whole + i * n + j])
        return felt != 0.0

    @outside(owner)
    def list_moving(w: np.ndarray) -> None:
        can, count = w[of.rates : of.rates + n], 0
        find_moving(w)
        for r in range(int(w[at.rotations])):
            can[int(w[at.references + r])] = -1.0
        for i in range(n):
            if can[i] > 0.0 or (can[i] == 0.0 and is_felt(w, i)):
                w[at.states + count] = i
                count += 1
        w[at.inside] = count

    return list_moving
