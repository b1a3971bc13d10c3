"""Step of the modal housing: exact for forces that are polynomials over the macro step."""

import math

import numpy as np

from herringbone.components.modal_housing import layout as at
from herringbone.components.modal_housing.motion import accelerate, count, write_motion
from herringbone.kernels import modal
from herringbone.kernels.compiling.jit import hot, kernel
from herringbone.kernels.signals import STRIDE, all_finite, monomial, shift, store_node
from herringbone.kernels.steppers import NOT_FINITE, TOO_LONG

_LONGEST_STEP = 1e6
"""Longest step [s] of a housing whose modes would all take more."""
SLOWEST = 2.0 * math.pi * 10.0
"""What rigid modes count as [rad/s] where sizes and steps are asked for."""


@kernel
def longest_step(b: np.ndarray) -> float:
    """Step [s] in which no mode turns by more than `modal.LONGEST_PHASE`."""
    longest = _LONGEST_STEP
    for i in range(count(b)):
        w = b[at.OMEGA + i]
        longest = min(longest, modal.LONGEST_PHASE / max(w + 2.0 * b[at.ZETA + i] * w, SLOWEST))
    return longest


@kernel
def _propagators(b: np.ndarray, w: np.ndarray, h: float) -> int:
    """Place in the work space of the propagators of a step; the oldest ones make room.

    0 if the step is too long for them.
    """
    filled = int(w[at.FILLED])
    for k in range(min(filled, at.STEPS)):
        if w[at.STEP_OF + k] == h:
            return at.PROPAGATORS + k * at.SLOT
    if not h <= longest_step(b):
        return 0
    slot = filled % at.STEPS
    place = at.PROPAGATORS + slot * at.SLOT
    scratch = w[at.SCRATCH : at.POLYNOMIALS]
    for i in range(count(b)):
        modal.propagator(b[at.OMEGA + i], b[at.ZETA + i], h, w, at.ONE, scratch)
        for entry in range(modal.PROPAGATOR):
            w[place + entry * at.MODES + i] = w[at.ONE + entry]
    w[at.STEP_OF + slot], w[at.FILLED] = h, filled + 1.0
    return place


@kernel
def _push(b: np.ndarray, seat: int, forces: np.ndarray, to: np.ndarray) -> None:
    """Add what one power of the forces at a seat does to the modes.

    The three forces are read before the loop, which lets the compiler take modes side by side.
    """
    first = seat * at.AXES
    f_x, f_y, f_z = (
        forces[first * STRIDE],
        forces[(first + 1) * STRIDE],
        forces[(first + 2) * STRIDE],
    )
    x = b[at.SHAPES + first * at.MODES : at.SHAPES + (first + at.AXES) * at.MODES]
    for i in range(count(b)):
        to[i] += x[i] * f_x + x[at.MODES + i] * f_y + x[2 * at.MODES + i] * f_z


@hot
def _project(b: np.ndarray, w: np.ndarray, degree: int) -> None:
    """Write the forces on the modes as polynomials of the time in intervals between nodes.

    By power, then by mode; powers above the degree that `modal.advance` takes are zero.
    """
    forces, of_modes = w[at.POLYNOMIALS : at.MODAL], w[at.MODAL :]
    for k in range(at.DOF_COUNT):
        monomial(b, at.FIRST_INPUT + k * STRIDE, degree, forces, k * STRIDE)
        shift(forces, k * STRIDE, degree, 0.0, 1.0 / max(degree, 1))
    for i in range(modal.powers_of(degree) * at.MODES):
        of_modes[i] = 0.0
    for j in range(degree + 1):
        for seat in range(at.SEATS):
            _push(b, seat, forces[j:], of_modes[j * at.MODES : (j + 1) * at.MODES])


@kernel
def step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    """Advance by h [s], exactly."""
    degree = int(b[at.DEGREE])
    intervals = max(degree, 1)
    place = _propagators(b, w, h / intervals)
    if place == 0:
        return TOO_LONG
    phi, forces = w[place : place + at.SLOT], w[at.MODAL :]
    _project(b, w, degree)
    for node in range(1, intervals + 1):
        modal.advance(b, phi, forces, degree, at.MODES, count(b))
        modal.next_interval(forces, degree, at.MODES, count(b))
        write_motion(b)
        store_node(b, at.FIRST_OUTPUT, at.OUTPUTS, node)
    accelerate(b, forces)
    return 0 if all_finite(b, 0, 2 * at.MODES) else NOT_FINITE
