"""States in the block that follow from the modal coordinates, which a core goes on with."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from herringbone.kernels.compiling.jit import inner, outside
from herringbone.kernels.compiling.views import matrix
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, kept_size
from herringbone.kernels.condensed.modal import add_product, copy

STALE, HOLDS, COORDINATES = 0, 1, 2
"""Places in what a core goes on with: which of the states and outputs in the block do not belong to
it, ALL or the UNASKED ones; 1 where the rest holds; then the coordinates, with angles themselves
where their growth stands in a step."""
UNASKED, ALL = 1, 2


class StateKernels(NamedTuple):
    """From coordinates to states, each (b, w).

    With a place for what is kept, states are not made when coordinates are left, but are stale from
    then on.

    Attributes:
        leave: the coordinates stay as they are, or become states.
        belongs: True if the states that are not stale are to the bit those that follow.
        settle: makes states that are stale.
        forget: does so, as they are to be changed.
    """

    leave: Callable
    belongs: Callable
    settle: Callable
    forget: Callable


def state_kernels(form: Form, at: WorkPlaces, equations: Equations) -> StateKernels:
    """Compile the ways from coordinates to states.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, kept, goes_on = equations.owner, equations.kept, equations.kept >= 0
    states_of, kept_states, write_states = _state_writers(form, at, equations)

    @outside(owner)
    def belongs(b: np.ndarray, w: np.ndarray) -> bool:
        if not goes_on or b[kept + HOLDS] == 0.0:
            return False
        if b[kept + STALE] != 0.0:
            return True
        kept_states(b, w)
        for i in range(int(w[at.inside])):
            if b[int(w[at.states + i])] != w[at.x + i]:
                return False
        return True

    @inner(owner)
    def settle(b: np.ndarray, w: np.ndarray) -> None:
        if goes_on and b[kept + STALE] != 0.0:
            kept_states(b, w)
            write_states(b, w)
            b[kept + STALE] = 0.0

    @inner(owner)
    def forget(b: np.ndarray, w: np.ndarray) -> None:
        if goes_on:
            settle(b, w)
            b[kept + HOLDS] = 0.0

    leave = _leaver(form, at, equations, states_of, write_states)
    return StateKernels(leave, belongs, settle, forget)


def _leaver(
    form: Form, at: WorkPlaces, equations: Equations, states_of: Callable, write_states: Callable
) -> Callable[[np.ndarray, np.ndarray], None]:
    """Compile leave(b, w)."""
    kept, goes_on, first = equations.kept, equations.kept >= 0, equations.kept + COORDINATES
    size = kept_size(form) - COORDINATES

    @inner(equations.owner)
    def leave(b: np.ndarray, w: np.ndarray) -> None:
        modes = int(w[at.modes])
        for r in range(int(w[at.rotations])):
            b[int(w[at.references + r])] += w[at.q + 2 * modes + r]
            w[at.q + 2 * modes + r] = 0.0
        if goes_on:
            b[kept + HOLDS], b[kept + STALE] = 1.0, ALL
            copy(w[at.q : at.q + size], b[first : first + size])
            for r in range(int(w[at.rotations])):
                b[first + 2 * modes + r] = b[int(w[at.references + r])]
        else:
            states_of(b, w)
            write_states(b, w)

    return leave


def _state_writers(
    form: Form, at: WorkPlaces, equations: Equations
) -> tuple[Callable, Callable, Callable]:
    """Compile states_of, kept_states and write_states, each (b, w).

    The states inside, in `at.x`, at the angles of the block and the coordinates there or those that
    are kept; and from `at.x` to the block.
    """
    owner, n, first = equations.owner, form.states, equations.kept + COORDINATES

    @inner(owner)
    def states_of(b: np.ndarray, w: np.ndarray) -> None:
        """Write the states inside to `at.x`, at the angles of the block."""
        inside, modes = int(w[at.inside]), int(w[at.modes])
        x = w[at.x : at.x + inside]
        for i in range(inside):
            x[i] = 0.0
        shapes = matrix(w, at.shapes, 2 * modes, inside)
        add_product(shapes, w[at.q : at.q + 2 * modes], x)
        for r in range(int(w[at.rotations])):
            angle, v = b[int(w[at.references + r])], w[at.rigid + r * n : at.rigid + (r + 1) * n]
            for i in range(inside):
                x[i] += v[int(w[at.states + i])] * angle

    @outside(owner)
    def kept_states(b: np.ndarray, w: np.ndarray) -> None:
        """As `states_of`, at the coordinates that are kept."""
        copy(b[first : first + at.q_size], w[at.q : at.q + at.q_size])
        states_of(b, w)

    @inner(owner)
    def write_states(b: np.ndarray, w: np.ndarray) -> None:
        for i in range(int(w[at.inside])):
            b[int(w[at.states + i])] = w[at.x + i]

    return states_of, kept_states, write_states
