"""Modal coordinates of what was taken apart, in the work space."""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.form import Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, taken_places
from herringbone.kernels.eigen.vectors import modes as find_modes


def mode_finder(form: Form, at: WorkPlaces, owner: str) -> Callable[[np.ndarray], bool]:
    """Compile find(w) -> bool: writes the modes, what acts on them and what is wanted of them.

    It is False if there are none.

    Args:
        form: of the component.
        at: places in the work space.
        owner: of the kernels.
    """
    eigenvalues, seen = _eigenvalue_finder(form, at, owner), _row_writer(at, owner)
    driven, channels, arguments = _channel_writer(form, at, owner), form.channels, form.arguments
    n, capacity, of = form.states, at.capacity, taken_places(form, at.rungs)

    @outside(owner)
    def in_modes(w: np.ndarray) -> None:
        k = 0
        for mode in range(int(w[at.modes])):
            for row in range(arguments):
                to = at.carg + row * capacity + mode
                seen(w, of.of_states + row * n, k, mode, to, arguments * capacity)
            for r in range(int(w[at.rotations])):
                to = at.turns + 2 * r * capacity + mode
                seen(w, of.whole + int(w[at.references + r]) * n, k, mode, to, capacity)
            for c in range(channels):
                driven(w, c, k, mode)
            k += 2 if w[at.rates + capacity + mode] != 0.0 else 1

    @outside(owner)
    def find(w: np.ndarray) -> bool:
        if not eigenvalues(w):
            return False
        in_modes(w)
        return True

    return find


def _eigenvalue_finder(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile eigenvalues(w) -> bool: finds the modes; False if there are none."""
    n, capacity, of = form.states, at.capacity, taken_places(form, at.rungs)

    @outside(owner)
    def eigenvalues(w: np.ndarray) -> bool:
        count = int(w[at.inside])
        states, a = w[at.states : at.states + count], w[of.matrix : of.matrix + count * count]
        for i in range(count):
            for j in range(count):
                a[i * count + j] = w[of.whole + int(states[i]) * n + int(states[j])]
        found = find_modes(
            a,
            w[at.rates : at.rates + count],
            w[of.rates : of.rates + count],
            w[at.shapes : at.shapes + count * count],
            w[at.back : at.back + count * count],
            w[of.room : of.end],
            count,
        )
        if found < 0 or found > capacity:
            return False
        w[at.modes] = found
        for mode in range(found):
            w[at.rates + capacity + mode] = w[of.rates + mode]
        return True

    return eigenvalues


def _row_writer(at: WorkPlaces, owner: str) -> Callable:
    """Compile seen(w, row, k, mode, to, apart)."""
    capacity = at.capacity

    @outside(owner)
    def seen(w: np.ndarray, row: int, k: int, mode: int, to: int, apart: int) -> None:
        """Write what a row over the states is of a mode, real and imaginary part `apart`."""
        g, h = 0.0, 0.0
        count = int(w[at.inside])
        pair = w[at.rates + capacity + mode] != 0.0
        for i in range(count):
            value = w[row + int(w[at.states + i])]
            g += value * w[at.shapes + i * count + k]
            if pair:
                h += value * w[at.shapes + i * count + k + 1]
        w[to], w[to + apart] = g, h

    return seen


def _channel_writer(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile driven(w, channel, k, mode)."""
    n, channels, capacity = form.states, form.channels, at.capacity
    of = taken_places(form, at.rungs)

    @outside(owner)
    def driven(w: np.ndarray, channel: int, k: int, mode: int) -> None:
        """Write what a channel does to a mode."""
        g, h = 0.0, 0.0
        count, rotations = int(w[at.inside]), int(w[at.rotations])
        pair = w[at.rates + capacity + mode] != 0.0
        for i in range(count):
            state = int(w[at.states + i])
            value = w[of.of_inputs + state * channels + channel]
            for r in range(rotations):
                rigid = w[at.rigid + r * n + state]
                if rigid != 0.0:
                    reference = int(w[at.references + r])
                    value -= rigid * w[of.of_inputs + reference * channels + channel]
            g += value * w[at.back + k * count + i]
            if pair:
                h -= value * w[at.back + (k + 1) * count + i]
        w[at.bq + channel * capacity + mode] = g
        w[at.bq + (channels + channel) * capacity + mode] = h

    return driven


def mode_arranger(at: WorkPlaces, owner: str) -> Callable[[np.ndarray], None]:
    """Compile arrange(w): `at.back` and `at.shapes` by columns, when the modes are checked.

    They are over the coordinates as a step has them.
    """
    capacity = at.capacity

    @outside(owner)
    def arrange(w: np.ndarray) -> None:
        count, modes, k = int(w[at.inside]), int(w[at.modes]), 0
        to, size = w[at.rungs :], 2 * modes * count
        for mode in range(modes):
            pair = w[at.rates + capacity + mode] != 0.0
            for i in range(count):
                back, shape = to[i * 2 * modes + mode :], to[size + mode * count + i :]
                back[0], back[modes] = w[at.back + k * count + i], 0.0
                shape[0], shape[modes * count] = w[at.shapes + i * count + k], 0.0
                if pair:
                    back[modes] = -w[at.back + (k + 1) * count + i]
                    shape[modes * count] = -w[at.shapes + i * count + k + 1]
            k += 2 if pair else 1
        for i in range(size):
            w[at.back + i], w[at.shapes + i] = to[i], to[size + i]

    return arrange
