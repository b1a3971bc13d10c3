"""Whether a component's rates are those of its modal coordinates and laws, and which outputs are.

So parameters are seen that make it otherwise than linear beside the laws.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.condensing.bent import (
    LONG_AFTER,
    bent_finder,
    channel_writer,
)
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import (
    WorkPlaces,
    taken_places,
)

_LINEAR = 1e-7
"""Largest deviation of rates, over the sizes of the terms that are added."""
_TURNED = 30.0
"""Angle [rad] by which all that rotates is turned, so that what comes in over some turns, as an
unbalance does, is there; differences of larger angles have too few digits."""


def checker(
    form: Form, at: WorkPlaces, equations: Equations
) -> Callable[[np.ndarray, np.ndarray, float], bool]:
    """Compile holds(b, w, t) -> bool, at the block's states and farther on; they stay.

    It notes which outputs are not affine.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, sizes, inputs = equations.owner, np.array(equations.sizes), equations.inputs
    prepare, n, input_count, outputs = equations.prepare, form.states, form.inputs, form.outputs
    of = taken_places(form, at.rungs)
    channels_at = channel_writer(form, at, equations)
    agrees = _rates_checker(form, at, equations, channels_at)
    find_bent = bent_finder(form, at, equations, channels_at)

    @outside(owner)
    def holds(b: np.ndarray, w: np.ndarray, t: float) -> bool:
        """True if it does here, and later where all states are larger and have turned on."""
        kept = w[of.room : of.room + n + input_count]
        for i in range(n):
            kept[i] = b[i]
        for k in range(input_count):
            kept[n + k] = b[inputs[k]]
        prepare(b)
        found = agrees(b, w, t)
        for i in range(int(w[at.inside])):
            state = int(w[at.states + i])
            b[state] += sizes[state]
            for r in range(int(w[at.rotations])):
                b[state] += _TURNED * w[at.rigid + r * n + state]
        for r in range(int(w[at.rotations])):
            b[int(w[at.references + r])] += _TURNED
        found = found and agrees(b, w, t + LONG_AFTER)
        for i in range(n):
            b[i] = kept[i]
        if found and outputs > 0:
            find_bent(b, w, t)
            for i in range(n):
                b[i] = kept[i]
        return found

    return holds


def _rates_checker(
    form: Form, at: WorkPlaces, equations: Equations, channels_at: Callable
) -> Callable:
    """Compile agrees(b, w, t) -> bool: True if the rates in the block's state are of the form."""
    owner, sizes, rhs = equations.owner, np.array(equations.sizes), equations.rhs
    n, of, from_modes = (
        form.states,
        taken_places(form, at.rungs),
        _rates_of_modes(form, at, equations.owner),
    )

    @outside(owner)
    def agrees(b: np.ndarray, w: np.ndarray, t: float) -> bool:
        dx = w[of.rates : of.rates + n]
        found, terms = w[of.rates + n : of.rates + 2 * n], w[of.rates + 2 * n : of.rates + 3 * n]
        angles = w[of.rates + 3 * n : of.rates + 4 * n]
        for i in range(n):
            w[at.x + i] = b[i]
        channels_at(b, w, t)
        from_modes(b, w)
        rhs(b, t, dx)
        for i in range(int(w[at.inside])):
            state = int(w[at.states + i])
            rate = dx[state]
            for r in range(int(w[at.rotations])):
                rate -= w[at.rigid + r * n + state] * dx[int(w[at.references + r])]
            if not abs(rate - found[i]) <= _LINEAR * terms[i]:
                return False
        for i in range(int(w[at.inside])):
            dx[int(w[at.states + i])] = 0.0
        for r in range(int(w[at.rotations])):
            turning = int(w[at.references + r])
            off = abs(dx[turning] - angles[r])
            if not off <= _LINEAR * (abs(angles[r]) + sizes[turning]):
                return False
            dx[turning] = 0.0
        for i in range(n):
            if dx[i] != 0.0:
                return False
        return True

    return agrees


def _rates_of_modes(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile from_modes(b, w): rates of the states inside, sizes of their terms, angles' rates."""
    n, channels, of, capacity = (
        form.states,
        form.channels,
        taken_places(form, at.rungs),
        at.capacity,
    )

    @outside(owner)
    def coordinate(b: np.ndarray, w: np.ndarray, i: int) -> float:
        """The state `inside` i without what rotates."""
        state = int(w[at.states + i])
        value = b[state]
        for r in range(int(w[at.rotations])):
            rigid = w[at.rigid + r * n + state]
            if rigid != 0.0:
                value -= rigid * b[int(w[at.references + r])]
        return value

    @outside(owner)
    def from_modes(b: np.ndarray, w: np.ndarray) -> None:
        count, u, k = int(w[at.inside]), w[at.now :], 0
        found, terms = w[of.rates + n : of.rates + 2 * n], w[of.rates + 2 * n : of.rates + 3 * n]
        angles = w[of.rates + 3 * n : of.rates + 4 * n]
        for i in range(n):
            found[i], terms[i], angles[i] = 0.0, 1e-300, 0.0
        for mode in range(int(w[at.modes])):
            pair = w[at.rates + capacity + mode] != 0.0
            p, q = 0.0, 0.0
            for i in range(count):
                value = coordinate(b, w, i)
                p += value * w[at.back + k * count + i]
                if pair:
                    q -= value * w[at.back + (k + 1) * count + i]
            for r in range(int(w[at.rotations])):
                turns = at.turns + 2 * r * capacity + mode
                angles[r] += p * w[turns] - q * w[turns + capacity]
            x, y = w[at.rates + mode], w[at.rates + capacity + mode]
            p, q = x * p - y * q, x * q + y * p
            size = abs(p) + abs(q)
            for c in range(channels):
                g, h = w[at.bq + c * capacity + mode], w[at.bq + (channels + c) * capacity + mode]
                p, q = p + g * u[c], q + h * u[c]
                size += (abs(g) + abs(h)) * abs(u[c])
            for i in range(count):
                g, h = w[at.shapes + i * count + k], 0.0
                if pair:
                    h = w[at.shapes + i * count + k + 1]
                found[i] += g * p - h * q
                terms[i] += (abs(g) + abs(h)) * size
            k += 2 if pair else 1

    return from_modes
