"""Forces of the bearings, from the motion on both sides of them."""

import numpy as np

from herringbone.components.bearing_supports import layout as at
from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.elementary import cosine, sine


@kernel
def radial_force(b: np.ndarray, gear: int, d: float, rate: float) -> float:
    """Radial bearing force [N] at relative displacement d [m] and its rate [m/s]."""
    play = 0.5 * b[at.CLEARANCE[gear]]
    loaded = d - max(-play, min(d, play))
    if play == 0.0:
        return b[at.K_R[gear]] * d + b[at.C_R[gear]] * rate
    g = min(1.0, abs(loaded) / (0.2 * play))
    force = b[at.K_R[gear]] * loaded + b[at.C_R[gear]] * g * rate
    return max(0.0, force) if loaded > 0.0 else min(0.0, force)


@kernel
def line_of_action(b: np.ndarray) -> tuple[float, float]:
    """Its unit vector in the housing frame."""
    n_x, n_y = sine(b[at.ANGLE]), cosine(b[at.ANGLE])
    return -n_x if b[at.FLANK] < 0.0 else n_x, n_y


@kernel
def approach(b: np.ndarray, i: int, n_x: float, n_y: float) -> tuple[float, float]:
    """Radial displacement of a half against its seat [m], and its rate [m/s]."""
    m = b[at.MOTION]
    d = b[at.S_Y[i]] - m * (n_x * b[at.SEAT_S_X[i]] + n_y * b[at.SEAT_S_Y[i]])
    return d, b[at.V_Y[i]] - m * (n_x * b[at.SEAT_V_X[i]] + n_y * b[at.SEAT_V_Y[i]])


@kernel
def write_forces(b: np.ndarray, i: int, n_x: float, n_y: float, radial: float) -> None:
    """Write the forces of a half's bearing with a given radial force [N]."""
    gear, m = i // 2, b[at.MOTION]
    b[at.F_Y[i]] = -radial
    b[at.SEAT_F_X[i]], b[at.SEAT_F_Y[i]] = radial * n_x, radial * n_y
    axial = b[at.K_A[gear]] * (b[at.S_Z[i]] - m * b[at.SEAT_S_Z[i]])
    axial += b[at.C_A[gear]] * (b[at.V_Z[i]] - m * b[at.SEAT_V_Z[i]])
    axial *= 1.0 - 0.5 * b[at.PER_SHAFT]
    b[at.F_Z[i]], b[at.SEAT_F_Z[i]] = -axial, axial
