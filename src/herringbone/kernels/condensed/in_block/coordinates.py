"""Modal coordinates of the states in the block, and their growth over a step."""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.condensed.in_block.columns import add_columns
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces


def coordinate_kernels(
    form: Form, at: WorkPlaces, equations: Equations
) -> tuple[Callable, Callable, Callable]:
    """Compile the ways between states and coordinates, and over a step.

    They are enter(b, w), which writes the laws there, too, leave(b, w), and advance(w, begin), with
    the rung that begins there.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, turning, laws = equations.owner, equations.turning, equations.laws
    values, arguments, kinks, tangents = form.values, form.arguments, form.kinks, len(form.mean)
    stiff, unknowns, tangent = np.array(form.stiff), len(form.stiff), form.tangent.ravel()
    degree, count, capacity = form.degree, form.degree + 1, at.capacity
    total = form.channels * count

    @inner(owner)
    def laws_there(b: np.ndarray, w: np.ndarray, modes: int) -> None:
        """Write the laws at the coordinates, as if a step had ended there."""
        z = w[at.z : at.z + arguments]
        for a in range(arguments):
            z[a] = w[at.of_angle + a] * b[turning]
        for mode in range(modes):
            x, y, row = w[at.q + mode], w[at.q + modes + mode], at.carg + mode
            for a in range(arguments):
                z[a] += w[row + a * capacity] * x - w[row + (arguments + a) * capacity] * y
        laws(b, z, w[at.f : at.f + values], w[at.k : at.k + tangents], w[at.e : at.e + kinks])
        for value in range(values):
            w[at.last + value * count + degree] = w[at.f + value]
        for s in range(unknowns):
            place = at.last + int(stiff[s]) * count + degree
            for a in range(arguments):
                w[place] -= tangent[s * arguments + a] * z[a]

    @inner(owner)
    def enter(b: np.ndarray, w: np.ndarray) -> None:
        inside, modes = int(w[at.inside]), int(w[at.modes])
        x = w[at.x : at.x + inside]
        for i in range(inside):
            x[i] = b[int(w[at.states + i])]
        for k in range(2 * modes + 1):
            w[at.q + k] = 0.0
        add_columns(w[at.back :], 2 * modes, x, inside, w[at.q :], 2 * modes)
        laws_there(b, w, modes)

    @inner(owner)
    def leave(b: np.ndarray, w: np.ndarray) -> None:
        inside, modes = int(w[at.inside]), int(w[at.modes])
        for i in range(inside):
            w[at.x + i] = 0.0
        add_columns(w[at.shapes :], inside, w[at.q :], 2 * modes, w[at.x :], inside)
        for i in range(inside):
            b[int(w[at.states + i])] = w[at.x + i]
        b[turning] += w[at.q + 2 * modes]

    @inner(owner)
    def advance(w: np.ndarray, begin: int) -> None:
        modes = int(w[at.modes])
        q, of_angle = w[at.q : at.q + 2 * modes + 1], w[begin + at.angle :]
        turn, other = w[begin + at.turn :], w[begin + at.turn + capacity :]
        first, second = 0.0, 0.0
        for mode in range(modes):
            x, y = q[mode], q[modes + mode]
            first += of_angle[mode] * x
            second += of_angle[modes + mode] * y
            q[mode] = turn[mode] * x - other[mode] * y
            q[modes + mode] = turn[mode] * y + other[mode] * x
        q[2 * modes] += first + second
        add_columns(w[begin + at.push :], at.q_size, w[at.v :], total, q, 2 * modes + 1)
        for k in range(kinks):
            w[at.e + k] = w[at.e + degree * kinks + k]
        for k in range(values * count):
            w[at.last + k] = w[at.u + k]

    return enter, leave, advance
