"""Whether a component's rates are those of its modal coordinates and laws, and which outputs are.

So parameters are seen that make it otherwise than linear beside the laws.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import (
    WorkPlaces,
    output_places,
    taken_places,
)

_LINEAR = 1e-7
"""Largest deviation of rates, over the sizes of the terms that are added."""
_SAME = 1e-9
"""Of an output, over the sizes of the terms that are added: a difference below is rounding."""
_FARTHER = (-10.0, 0.1, 100.0)
"""Usual sizes by which states and inputs are moved to see which outputs are affine."""
_LATER = 1e3
"""Time [s] after which nothing is brought in any more."""


def checker(  # noqa: PLR0915 (kernels that share their layout)
    form: Form, at: WorkPlaces, equations: Equations
) -> Callable[[np.ndarray, np.ndarray, float], bool]:
    """Compile holds(b, w, t) -> bool, at the block's states and where all are larger; they stay.

    It notes which outputs are not affine.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, sizes, inputs = equations.owner, np.array(equations.sizes), equations.inputs
    rhs, out, given, prepare = equations.rhs, equations.out, equations.given, equations.prepare
    laws, signals = equations.laws, equations.signals
    n, channels, arguments, values = form.states, form.channels, form.arguments, form.values
    stiff, unknowns, tangent = np.array(form.stiff), len(form.stiff), form.tangent.ravel()
    signal_count, first_input, input_count = form.signals, values + form.signals, form.inputs
    of, capacity, rows = taken_places(form, at.rungs), at.capacity, n + form.outputs
    shown, farther = form.shown, np.array(_FARTHER)
    outputs, places, timed = form.outputs, output_places(form.shown), np.array([*shown.timed, -1])

    @outside(owner)
    def channels_at(b: np.ndarray, w: np.ndarray, t: float) -> None:
        """Write the channels in the state of `at.x`, laws' values less their mean tangents."""
        x, u, z = w[at.x : at.x + n], w[at.now :], w[at.start : at.start + arguments]
        signals(b, t, u[values : values + signal_count])
        for k in range(input_count):
            u[first_input + k] = b[inputs[k]]
        given(b, x, u, w[of.rates : of.rates + rows], z)
        laws(b, t, z, u, w[at.k :], w[at.e :])
        for s in range(unknowns):
            for k in range(arguments):
                u[int(stiff[s])] -= tangent[s * arguments + k] * z[k]
        u[channels - 1] = 1.0

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
        """Write rates of the states inside, sizes of their terms, then rates of the angles."""
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

    @outside(owner)
    def agrees(b: np.ndarray, w: np.ndarray, t: float) -> bool:
        """True if the rates in the block's state are those of the form."""
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

    @outside(owner)
    def note_bent(b: np.ndarray, w: np.ndarray, t: float) -> None:
        """Note the outputs that are not those of the form in the block's state."""
        for i in range(n):
            w[at.x + i] = b[i]
        channels_at(b, w, t)
        out(b, t)
        for k in range(outputs):
            row, y, terms = n + k, 0.0, 1e-300
            for i in range(n):
                term = w[of.whole + row * n + i] * b[i]
                y += term
                terms += abs(term)
            for c in range(channels):
                term = w[of.of_inputs + row * channels + c] * w[at.now + c]
                y += term
                terms += abs(term)
            if not abs(y - b[int(places[k])]) <= _SAME * terms:
                w[at.bent + k] = 1.0

    @outside(owner)
    def find_bent(b: np.ndarray, w: np.ndarray, t: float) -> None:
        """Note the outputs that are not affine; states and inputs are those in `of.room`."""
        kept = w[of.room : of.room + n + input_count]
        for k in range(outputs):
            w[at.bent + k] = 0.0
        for k in range(timed.size - 1):
            w[at.bent + timed[k]] = 1.0
        note_bent(b, w, t)
        for k in range(farther.size):
            far = farther[k]
            for i in range(n):
                b[i] = kept[i] + far * sizes[i] * (1.0 + 0.125 * (i % 8))
            for j in range(input_count):
                b[inputs[j]] = kept[n + j] + far * (1.0 + abs(kept[n + j]))
            note_bent(b, w, t + _LATER)
        for k in range(input_count):
            b[inputs[k]] = kept[n + k]

    @outside(owner)
    def holds(b: np.ndarray, w: np.ndarray, t: float) -> bool:
        """True if it does here, and where all states are larger, now and later."""
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
        found = found and agrees(b, w, t + _LATER)
        for i in range(n):
            b[i] = kept[i]
        if found and outputs > 0:
            find_bent(b, w, t)
            for i in range(n):
                b[i] = kept[i]
        return found

    return holds
