"""Directional derivatives of a component, from its own kernels by forward mode."""

from collections.abc import Callable

import numpy as np

from herringbone.core import Component
from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.derivatives.forward_mode import differentiate

Tangent = Callable[[np.ndarray, float, np.ndarray, np.ndarray], None]


def tangent_kernel(component: Component) -> Tangent:
    """Compile the directional derivative of a component's outputs and state derivatives.

    Returns:
        tangent(b, t, d, dx): block; time [s]; direction, as long as the block, zero outside of
        states, inputs and parameters; receives the tangents of outputs and locals; `dx`
        (2 state_count long) receives the states' derivatives, then their tangents. Also writes the
        outputs of `b`.

    Raises:
        NotDifferentiableError: a kernel uses what forward mode does not know.
    """
    out, rhs = differentiate(component.kernels.out, component.kernels.rhs)
    states = component.declaration.state_count

    @inner(component.name)
    def tangent(b: np.ndarray, t: float, d: np.ndarray, dx: np.ndarray) -> None:
        out(b, d, t, 0.0)
        rhs(b, d, t, 0.0, dx[:states], dx[states:])

    return tangent
