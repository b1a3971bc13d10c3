"""A mesh with deviations of single teeth, on one flank at least."""

import math

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.gear_mesh.excitation import impact, turn_errors
from herringbone.components.gear_mesh.ramp import ramp, turn_ramp
from herringbone.components.gear_mesh.teeth import toothed
from herringbone.components.resources import tooth_deviations
from herringbone.kernels import force_law
from herringbone.kernels.compiling.jit import rare

OPEN = 1e-12
"""Depth [m] at which flanks that are open have their tangent stiffness."""
SOFT = 1e-3
"""Least tangent stiffness [N/m] whose root is taken."""


@rare
def _elastic(
    b: np.ndarray, side: int, flank: int, phase: float, depth: float
) -> tuple[float, float, float, float]:
    """Force [N], tangent [N/m] and dU/d(phase) [J] of flanks, and how deep they press [m].

    Adds the torque of what brings the deviations in.
    """
    if tooth_deviations.given(b, at.DEVIATIONS, side, flank):
        share, slope = ramp(b)
        force, tangent, of_phase, of_ramp, x, _ = toothed(b, side, flank, phase, depth, share)
        turn_ramp(b, -of_ramp * slope)
        return force, tangent, of_phase, x
    if depth <= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    table = at.TABLE[0] + side * force_law.TABLE_SIZE
    force, tangent, of_phase = force_law.law(b, table, phase, depth)
    return force, tangent, of_phase, depth


@rare
def _pressure(
    b: np.ndarray,
    side: int,
    f: float,
    phase: float,
    depth: float,
    rate: float,
    force: float,
    tangent: float,
    x: float,
) -> float:
    """Pressure [N] of flanks whose teeth deviate, from their elastic force and tangent.

    Args:
        b, side, f, phase, depth, rate: as of `_flank`.
        force, tangent: elastic [N, N/m].
        x: how deep they press [m].
    """
    if b[at.GATE] == 0.0:
        table = at.TABLE[0] + side * force_law.TABLE_SIZE
        _, tangent, _ = force_law.law(b, table, phase, max(depth, OPEN))
    damping = 2.0 * b[at.ZETA] * math.sqrt(max(tangent, SOFT) * b[at.PATH_MASS])
    g = max(0.0, min(1.0, x * b[at.PER_TRANSITION]))
    g *= g * (3.0 - 2.0 * g)
    if b[at.IMPACT] > 0.0 and (f > 0.0) == (b[at.FLANK] >= 0.0):
        force += g * impact(b, f, phase)
    if b[at.GATE] == 0.0:
        return force + damping * rate
    return max(0.0, force + damping * g * rate)


@rare
def deviating(
    b: np.ndarray,
    side: int,
    drive: float,
    drive_rate: float,
    coast: float,
    coast_rate: float,
    phase: float,
) -> tuple[float, float]:
    """Normal force and push [N] of a mesh with deviations of single teeth; see `_mesh`."""
    normal, push, open_flanks = 0.0, b[at.HELD + side], b[at.GATE] == 0.0
    for k in range(2):
        flank = 1 - k  # coast first: without a gate open flanks are damped as the drive flank
        f, own, depth, rate = 1.0, phase, drive, drive_rate
        if flank == 1:
            f, own, depth, rate = -1.0, b[at.COAST_PHASE] - phase, coast, coast_rate
        force, tangent, slope, x = _elastic(b, side, flank, own, depth)
        b[at.PRESSED + 2 * side + flank] = x if force > 0.0 else 0.0
        b[at.TANGENT + 2 * side + flank] = tangent
        if force > 0.0 or (open_flanks and flank == 0):
            open_flanks = False
            pressure = _pressure(b, side, f, own, depth, rate, force, tangent, x)
            normal += f * pressure
            push += f * slope
            if b[at.ERRORS] > 0.0:
                turn_errors(b, side, flank, pressure)
    return normal, b[at.COS] * normal + b[at.PER_PITCH] * push
