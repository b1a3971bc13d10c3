"""Forces of both meshes and all their reactions on the bodies."""

import math

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.gear_mesh.excitation import error, impact, turn_errors, wheel
from herringbone.components.gear_mesh.toothed_mesh import OPEN, deviating
from herringbone.kernels import force_law
from herringbone.kernels.compiling.jit import kernel, rare
from herringbone.kernels.elementary import cosine, sine, sine_and_cosine


@kernel
def derive(b: np.ndarray) -> None:
    """Write what follows from the parameters alone."""
    b[at.COS], b[at.SIN] = cosine(b[at.BETA]), sine(b[at.BETA])
    b[at.TAN] = b[at.SIN] / b[at.COS]
    b[at.PHASE_RATE] = b[at.TEETH[0]] / at.TWO_PI
    b[at.PER_PITCH] = b[at.PHASE_RATE] / b[at.RB[0]]
    b[at.AXIAL_PHASE] = b[at.TAN] * b[at.PER_PITCH]
    b[at.PATH_MASS] = 1.0 / (
        b[at.RB[0]] ** 2 / b[at.INERTIAS[0]] + b[at.RB[1]] ** 2 / b[at.INERTIAS[1]]
    )
    b[at.PER_TRANSITION], b[at.PER_WHEEL_RB] = 1.0 / b[at.TRANSITION], 1.0 / b[at.RB[1]]
    for gear in range(2):
        b[at.PER_MASS[gear]], b[at.PER_INERTIA[gear]] = (
            1.0 / b[at.MASSES[gear]],
            1.0 / b[at.INERTIAS[gear]],
        )


@kernel
def _apex(b: np.ndarray) -> tuple[float, float, float, float]:
    """eps_z [m], its rate [m/s], its slopes over the mean angles of pinion and wheel [m/rad]."""
    if b[at.F_A] == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    sin_p, cos_p = sine_and_cosine(b[at.ANGLE] + 0.5 * b[at.TWIST_P] + b[at.PHI1])
    sin_w, cos_w = sine_and_cosine(wheel(b, 0) + 0.5 * b[at.TWIST_W] + b[at.PHI2])
    offset = b[at.F_A] * (b[at.C0] + b[at.C1] * cos_p + b[at.C2] * cos_w)
    per_pinion, per_wheel = -b[at.F_A] * b[at.C1] * sin_p, -b[at.F_A] * b[at.C2] * sin_w
    rate = per_pinion * (b[at.ANGLE + at.RATE] + 0.5 * b[at.TWIST_P + at.RATE])
    rate += per_wheel * (wheel(b, 1) + 0.5 * b[at.TWIST_W + at.RATE])
    return offset, rate, per_pinion, per_wheel


@kernel
def _flank(
    b: np.ndarray, side: int, f: float, phase: float, depth: float, rate: float
) -> tuple[float, float]:
    """Pressure [N] between two flanks (f: 1 drive, -1 coast), and dU/d(phase) [J].

    Open flanks have the damping that their contact begins with; it acts if it is not gated.
    """
    x = depth if depth > 0.0 else OPEN
    force, tangent, slope = force_law.law(b, at.TABLE[0] + side * force_law.TABLE_SIZE, phase, x)
    b[at.TANGENT + 2 * side + (0 if f > 0.0 else 1)] = tangent
    damping = 2.0 * b[at.ZETA] * math.sqrt(max(0.0, tangent) * b[at.PATH_MASS])
    if depth <= 0.0:
        return damping * rate, 0.0
    g = min(1.0, depth * b[at.PER_TRANSITION])
    g *= g * (3.0 - 2.0 * g)
    if b[at.IMPACT] > 0.0 and (f > 0.0) == (b[at.FLANK] >= 0.0):
        force += g * impact(b, f, phase)
    if b[at.GATE] == 0.0:
        return force + damping * rate, slope
    return max(0.0, force + damping * g * rate), slope


@kernel
def approach(b: np.ndarray, side: int, eps: float, eps_rate: float) -> tuple[float, float, float]:
    """delta [m], its rate [m/s] and the phase [mesh periods] of mesh 0 (left) or 1 (right)."""
    s = 1.0 - 2.0 * side
    y, z = at.Y + side, at.Z + side
    path = b[at.APPROACH] + side * (b[at.RB[0]] * b[at.TWIST_P] - b[at.RB[1]] * b[at.TWIST_W])
    axial = b[z] - b[z + 2] + eps
    delta = b[at.COS] * (b[y] - b[y + 2] + path) + s * b[at.SIN] * axial
    phase = b[at.PHASE_RATE] * (b[at.ANGLE] + side * b[at.TWIST_P])
    phase += s * b[at.AXIAL_PHASE] * axial + side * b[at.STAGGER]
    y, z = y + at.RATE, z + at.RATE
    path = b[at.APPROACH + at.RATE] + side * (
        b[at.RB[0]] * b[at.TWIST_P + at.RATE] - b[at.RB[1]] * b[at.TWIST_W + at.RATE]
    )
    rate = b[at.COS] * (b[y] - b[y + 2] + path) + s * b[at.SIN] * (b[z] - b[z + 2] + eps_rate)
    return delta, rate, phase


@kernel
def _mesh(
    b: np.ndarray, side: int, delta: float, delta_rate: float, phase: float
) -> tuple[float, float]:
    """Normal force and push [N] of a mesh; writes its depths, adds the torques of its error."""
    drive, coast = delta, -b[at.BACKLASH] - delta
    rate, coast_rate = delta_rate, -delta_rate
    if b[at.ERRORS] > 0.0:
        e, e_rate, _, _, _ = error(b, side, 0)
        drive, rate = drive - e, rate - e_rate
        e, e_rate, _, _, _ = error(b, side, 1)
        coast, coast_rate = coast - e, coast_rate - e_rate
    b[at.DEPTH + 2 * side], b[at.DEPTH + 2 * side + 1] = drive, coast
    if b[at.DEVIATIONS] > 0.0:
        return deviating(b, side, drive, rate, coast, coast_rate, phase)
    normal, push = 0.0, b[at.HELD + side]
    first = 0 if drive > 0.0 or (b[at.GATE] == 0.0 and coast <= 0.0) else 1
    last = 2 if coast > 0.0 else 1
    for flank in range(first, last):
        f, own, depth, depth_rate = 1.0, phase, drive, rate
        if flank == 1:
            f, own, depth, depth_rate = -1.0, b[at.COAST_PHASE] - phase, coast, coast_rate
        pressure, slope = _flank(b, side, f, own, depth, depth_rate)
        normal += f * pressure
        push += f * slope
        if b[at.ERRORS] > 0.0:
            turn_errors(b, side, flank, pressure)
    return normal, b[at.COS] * normal + b[at.PER_PITCH] * push


@kernel
def meshes(b: np.ndarray) -> tuple[float, float, float, float, float]:
    """eps_z [m], normal forces and pushes [N] of both meshes, left before right, after `derive`.

    Writes them, depths, tangents, and the torques of what is moved by a rotation.
    """
    for i in range(4):
        b[at.TORQUE + i] = b[at.HELD + 2 + i]
    eps, eps_rate, per_pinion, per_wheel = _apex(b)
    left, left_rate, left_phase = approach(b, 0, eps, eps_rate)
    right, right_rate, right_phase = approach(b, 1, eps, eps_rate)
    normal_left, push_left = _mesh(b, 0, left, left_rate, left_phase)
    normal_right, push_right = _mesh(b, 1, right, right_rate, right_phase)
    b[at.NORMAL], b[at.NORMAL + 1] = normal_left, normal_right
    if b[at.F_A] != 0.0:
        thrust = 0.5 * b[at.TAN] * (push_left - push_right)
        for half in range(2):
            b[at.TORQUE + half] -= thrust * per_pinion
            b[at.TORQUE + 2 + half] -= thrust * per_wheel
    return eps, normal_left, normal_right, push_left, push_right


@rare
def _piece(b: np.ndarray, depths: int, whole: float) -> int:
    """See `piece`; not 0."""
    found = 1
    for side in range(2):
        force = b[at.NORMAL + side]
        found = 3 * found + (1 if force > 0.0 else 0) + (2 if force < 0.0 else 0)
        for flank in range(2):
            depth = b[depths + 2 * side + flank]
            found = 3 * found + (1 if depth > 0.0 else 0) + (1 if depth > whole else 0)
    return found


@kernel
def piece(b: np.ndarray) -> int:
    """On which smooth piece of its law each mesh is, after `meshes`; 0 if both drive.

    The force bends where teeth meet and part, where damping would pull, and where it is whole.
    """
    depths = at.DEPTH if b[at.DEVIATIONS] == 0.0 else at.PRESSED
    whole = b[at.TRANSITION] if b[at.GATE] != 0.0 else 0.0
    least, forces = min(b[depths], b[depths + 2]), min(b[at.NORMAL], b[at.NORMAL + 1])
    if forces > 0.0 and least > whole and max(b[depths + 1], b[depths + 3]) <= 0.0:
        return 0
    return _piece(b, depths, whole)
