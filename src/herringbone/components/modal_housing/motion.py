"""Motion of the modal housing: what modes do under forces, and what the seats then do."""

import numpy as np

from herringbone.components.modal_housing import layout as at
from herringbone.kernels.compiling.jit import hot, kernel
from herringbone.kernels.signals import STRIDE


@kernel
def count(b: np.ndarray) -> int:
    """Number of modes; with the bound, the compiler sees that no index is negative."""
    return min(int(b[at.COUNT]), at.MODES)


@kernel
def _modal_force(b: np.ndarray, mode: int, forces: np.ndarray, stride: int) -> float:
    """Force on a mode, under forces at the seats that lie `stride` apart."""
    total = 0.0
    for k in range(at.DOF_COUNT):
        total += b[at.SHAPES + k * at.MODES + mode] * forces[k * stride]
    return total


@kernel
def _acceleration(b: np.ndarray, mode: int, force: float) -> float:
    w = b[at.OMEGA + mode]
    return force - w * (2.0 * b[at.ZETA + mode] * b[at.MODES + mode] + w * b[mode])


@kernel
def rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    """Derivatives of all states."""
    for i in range(at.MODES):
        dx[i] = b[at.MODES + i]
        dx[at.MODES + i] = 0.0
    forces = b[at.FIRST_INPUT : at.FIRST_OUTPUT]
    for i in range(count(b)):
        dx[at.MODES + i] = _acceleration(b, i, _modal_force(b, i, forces, STRIDE))


@hot
def write_motion(b: np.ndarray) -> None:
    """Write position and velocity of the seats from those of the modes.

    Every fourth mode is summed apart, so that additions go side by side. The sums are then stored,
    which lets the compiler keep them together in the loop.
    """
    sums = b[at.SUMS : at.SUMS + at.PARTIAL]
    fours = (count(b) + 3) // 4
    for k in range(at.DOF_COUNT):
        row = b[at.SHAPES + k * at.MODES : at.SHAPES + (k + 1) * at.MODES]
        s_0, s_1, s_2, s_3 = 0.0, 0.0, 0.0, 0.0
        v_0, v_1, v_2, v_3 = 0.0, 0.0, 0.0, 0.0
        for four in range(fours):
            i = 4 * four
            s_0 += row[i] * b[i]
            s_1 += row[i + 1] * b[i + 1]
            s_2 += row[i + 2] * b[i + 2]
            s_3 += row[i + 3] * b[i + 3]
            v_0 += row[i] * b[at.MODES + i]
            v_1 += row[i + 1] * b[at.MODES + i + 1]
            v_2 += row[i + 2] * b[at.MODES + i + 2]
            v_3 += row[i + 3] * b[at.MODES + i + 3]
        sums[0], sums[1], sums[2], sums[3] = s_0, s_1, s_2, s_3
        sums[4], sums[5], sums[6], sums[7] = v_0, v_1, v_2, v_3
        b[at.S + 2 * STRIDE * k] = (sums[0] + sums[2]) + (sums[1] + sums[3])
        b[at.V + 2 * STRIDE * k] = (sums[4] + sums[6]) + (sums[5] + sums[7])


@hot
def accelerate(b: np.ndarray, forces: np.ndarray) -> None:
    """Write the accelerations of modes and seats under the forces on the modes."""
    for i in range(count(b)):
        b[at.ACCELERATIONS + i] = _acceleration(b, i, forces[i])
    sums = b[at.SUMS : at.SUMS + at.PARTIAL]
    fours = (count(b) + 3) // 4
    for k in range(at.DOF_COUNT):
        row = b[at.SHAPES + k * at.MODES : at.SHAPES + (k + 1) * at.MODES]
        a_0, a_1, a_2, a_3 = 0.0, 0.0, 0.0, 0.0
        for four in range(fours):
            i = 4 * four
            a_0 += row[i] * b[at.ACCELERATIONS + i]
            a_1 += row[i + 1] * b[at.ACCELERATIONS + i + 1]
            a_2 += row[i + 2] * b[at.ACCELERATIONS + i + 2]
            a_3 += row[i + 3] * b[at.ACCELERATIONS + i + 3]
        sums[0], sums[1], sums[2], sums[3] = a_0, a_1, a_2, a_3
        b[at.A + k] = (sums[0] + sums[2]) + (sums[1] + sums[3])


@kernel
def out(b: np.ndarray, t: float) -> None:
    """Write all outputs."""
    forces = b[at.FIRST_INPUT : at.FIRST_OUTPUT]
    of_modes = b[at.ACCELERATIONS : at.ACCELERATIONS + at.MODES]
    for i in range(count(b)):
        of_modes[i] = _modal_force(b, i, forces, STRIDE)
    write_motion(b)
    accelerate(b, of_modes)


@kernel
def start(b: np.ndarray) -> None:
    """Static deflection under the start forces; rigid modes stay at zero."""
    for i in range(2 * at.MODES):
        b[i] = 0.0
    forces = b[at.START_FORCES : at.START_FORCES + at.DOF_COUNT]
    for i in range(count(b)):
        w = b[at.OMEGA + i]
        if w > 0.0:
            b[i] = _modal_force(b, i, forces, 1) / (w * w)
