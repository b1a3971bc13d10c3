"""Whether a component's rates are those of its modal coordinates and laws.

So parameters are seen that make it otherwise than linear beside the laws.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, taken_places

_LINEAR = 1e-7
"""Largest deviation of rates, over the sizes of the terms that are added."""


def checker(  # noqa: PLR0915 (kernels that share their layout)
    form: Form, at: WorkPlaces, equations: Equations
) -> Callable[[np.ndarray, np.ndarray, float], bool]:
    """Compile holds(b, w, t) -> bool, at the block's states and where all are larger; they stay.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, turning, inputs, sizes = (
        equations.owner,
        equations.turning,
        *map(np.array, equations[2:4]),
    )
    rhs, given, prepare, laws = equations[4:8]
    n, channels, arguments, of = (
        form.states,
        form.channels,
        form.arguments,
        taken_places(form, at.rungs),
    )
    values, stiff, unknowns, tangent = (
        form.values, np.array(form.stiff), len(form.stiff), form.tangent.ravel()
    )  # fmt: skip
    capacity, input_count = at.capacity, form.inputs

    @outside(owner)
    def channels_at(b: np.ndarray, w: np.ndarray) -> None:
        """Write the channels in the state of `at.x`, laws' values less their mean tangents."""
        x, u, z = w[at.x : at.x + n], w[at.u :], w[at.z : at.z + arguments]
        given(b, x, u, w[of.rates : of.rates + n], z)
        laws(b, z, u, w[at.k :], w[at.e :])
        for s in range(unknowns):
            for k in range(arguments):
                u[int(stiff[s])] -= tangent[s * arguments + k] * z[k]
        for k in range(input_count):
            u[values + k] = b[inputs[k]]
        u[channels - 1] = 1.0

    @outside(owner)
    def agrees(b: np.ndarray, w: np.ndarray, t: float) -> bool:
        """True if the rates in the block's state are those of the form."""
        count, u = int(w[at.inside]), w[at.u :]
        dx, found = w[of.rates : of.rates + n], w[of.rates + n : of.rates + 2 * n]
        terms = w[of.rates + 2 * n : of.rates + 3 * n]
        for i in range(n):
            w[at.x + i] = b[i]
        channels_at(b, w)
        for i in range(count):
            found[i], terms[i] = 0.0, 1e-300
        k, angle = 0, 0.0
        for mode in range(int(w[at.modes])):
            pair = w[at.rates + capacity + mode] != 0.0
            p, q = 0.0, 0.0
            for i in range(count):
                value = b[int(w[at.states + i])]
                p += value * w[at.back + k * count + i]
                if pair:
                    q -= value * w[at.back + (k + 1) * count + i]
            angle += p * w[at.turns + mode] - q * w[at.turns + capacity + mode]
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
        rhs(b, t, dx)
        for i in range(count):
            if not abs(dx[int(w[at.states + i])] - found[i]) <= _LINEAR * terms[i]:
                return False
        return abs(dx[turning] - angle) <= _LINEAR * (abs(angle) + sizes[turning])

    @outside(owner)
    def holds(b: np.ndarray, w: np.ndarray, t: float) -> bool:
        """True if it does here, and where all states are larger."""
        kept = w[of.room : of.room + n]
        for i in range(n):
            kept[i] = b[i]
        prepare(b)
        found = agrees(b, w, t)
        for i in range(int(w[at.inside])):
            state = int(w[at.states + i])
            b[state] += sizes[state]
        found = found and agrees(b, w, t)
        for i in range(n):
            b[i] = kept[i]
        return found

    return holds
