"""Motion of the four half-bodies under the forces of shafts, meshes and ports."""

import math

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.gear_mesh.contact import derive, meshes, piece
from herringbone.components.gear_mesh.excitation import wheel
from herringbone.components.gear_mesh.ramp import ramp, ramp_speed, turn_ramp
from herringbone.kernels import force_law, steppers
from herringbone.kernels.compiling.jit import kernel, rare
from herringbone.kernels.elementary import sine_and_cosine


@rare
def drag(b: np.ndarray, w: float) -> float:
    """Drag torque [N m] on a pinion half at its speed [rad/s]."""
    return 0.5 * b[at.DRAG] * w / math.sqrt(1.0 + w * w)


@rare
def _unbalance(b: np.ndarray, gear: int, half: int) -> tuple[float, float, float]:
    """Sine and cosine of the angle of a half's unbalance from +y, and its speed [rad/s]."""
    twist = at.TWIST_P + 2 * gear
    psi, w = b[at.ANGLE], b[at.ANGLE + at.RATE]
    if gear == 1:
        psi, w = wheel(b, 0), wheel(b, 1)
    s, c = sine_and_cosine(psi + half * b[twist] + b[at.UNBALANCE_PHASE[0] + gear * at.GEAR])
    return s, c, w + half * b[twist + at.RATE]


@rare
def _come_in(b: np.ndarray, gear: int) -> None:
    """Add the torques of an unbalance that comes in: on its halves, and on what brings it in."""
    _, slope = ramp(b)
    u = 0.5 * b[at.UNBALANCE[0] + gear * at.GEAR]
    for half in range(2):
        body = 2 * gear + half
        s, _, w = _unbalance(b, gear, half)
        push = u * slope * s * b[at.Y + body + at.RATE]
        b[at.TORQUE + body] += push * ramp_speed(b)
        turn_ramp(b, -push * w)


@rare
def _swing(b: np.ndarray, gear: int, half: int, a: float, alpha: float) -> tuple[float, float]:
    """Accelerations of y and theta of a half with unbalance, from those without."""
    own = gear * at.GEAR
    u, m, i = 0.5 * b[at.UNBALANCE[0] + own], b[at.MASSES[0] + own], b[at.INERTIAS[0] + own]
    share, slope = ramp(b)
    s, c, w = _unbalance(b, gear, half)
    grow = u * s * slope * ramp_speed(b)
    force, torque = m * a + share * u * c * w * w + grow * w, i * alpha
    us = share * u * s
    per = 1.0 / (m * i - us * us)
    return per * (i * force + us * torque), per * (m * torque + us * force)


@kernel
def _gap_shaft(b: np.ndarray, gear: int) -> tuple[float, float, float]:
    """Forces [N] and torque [N m] of the shaft between the halves of a gear."""
    own, y, z, twist = gear * at.GEAR, at.Y + 2 * gear, at.Z + 2 * gear, at.TWIST_P + 2 * gear
    bend = b[at.K_Y[0] + own] * (b[y] - b[y + 1])
    bend += b[at.C_Y[0] + own] * (b[y + at.RATE] - b[y + 1 + at.RATE])
    stretch = b[at.K_Z[0] + own] * (b[z] - b[z + 1])
    stretch += b[at.C_Z[0] + own] * (b[z + at.RATE] - b[z + 1 + at.RATE])
    torsion = b[at.K_T[0] + own] * b[twist] + b[at.C_T[0] + own] * b[twist + at.RATE]
    return bend, stretch, torsion


@kernel
def derivatives(
    b: np.ndarray,
    dx: np.ndarray,
    normal_left: float,
    normal_right: float,
    push_left: float,
    push_right: float,
    dragged: bool,
) -> None:
    """Derivatives of all states under the forces of `meshes`, and of the drag if it acts."""
    for gear in range(2):
        if b[at.UNBALANCE[0] + gear * at.GEAR] > 0.0:
            _come_in(b, gear)
    for i in range(at.RATE):
        dx[i] = b[i + at.RATE]
    thrust_left, thrust_right = b[at.TAN] * push_left, b[at.TAN] * push_right
    normal_left *= b[at.COS]
    normal_right *= b[at.COS]
    for gear in range(2):
        sign = -1.0 if gear == 0 else 1.0
        first, own = 2 * gear, gear * at.GEAR
        per_mass, per_inertia, rb = (
            b[at.PER_MASS[0] + gear],
            b[at.PER_INERTIA[0] + gear],
            b[at.RB[0] + own],
        )
        y, z, twist = at.Y + first, at.Z + first, at.TWIST_P + first
        bend, stretch, torsion = _gap_shaft(b, gear)
        dx[y + at.RATE] = (b[at.F_Y[0] + first * at.HALF] - bend + sign * normal_left) * per_mass
        dx[y + 1 + at.RATE] = (
            b[at.F_Y[0] + (first + 1) * at.HALF] + bend + sign * normal_right
        ) * per_mass
        force_left = b[at.F_Z[0] + first * at.HALF] - stretch + sign * thrust_left
        force_right = b[at.F_Z[0] + (first + 1) * at.HALF] + stretch - sign * thrust_right
        tau, share = b[at.TAU[0] + gear * at.FLANGE], b[at.SHARE[0] + own]
        turn_left = share * tau + torsion + b[at.TORQUE + first]
        turn_right = (1.0 - share) * tau - torsion + b[at.TORQUE + first + 1]
        if gear == 0:
            hold = 0.25 * b[at.RESTRAINT] * (b[z] + b[z + 1])
            force_left -= hold + b[at.AXIAL_DRAG] * b[z + at.RATE]
            force_right -= hold + b[at.AXIAL_DRAG] * b[z + 1 + at.RATE]
            turn_left -= rb * push_left
            turn_right -= rb * push_right
            if dragged and b[at.DRAG] > 0.0:
                w = b[at.ANGLE + at.RATE]
                turn_left -= drag(b, w)
                turn_right -= drag(b, w + b[twist + at.RATE])
        else:
            turn_left += rb * normal_left
            turn_right += rb * normal_right
        dx[z + at.RATE] = force_left * per_mass
        dx[z + 1 + at.RATE] = force_right * per_mass
        turn_left *= per_inertia
        turn_right *= per_inertia
        if b[at.UNBALANCE[0] + own] > 0.0:
            y += at.RATE
            dx[y], turn_left = _swing(b, gear, 0, dx[y], turn_left)
            dx[y + 1], turn_right = _swing(b, gear, 1, dx[y + 1], turn_right)
        dx[twist + at.RATE] = turn_right - turn_left
        if gear == 0:
            dx[at.ANGLE + at.RATE] = turn_left
            dx[at.APPROACH + at.RATE] = rb * turn_left
        else:
            dx[at.APPROACH + at.RATE] -= rb * turn_left


@kernel
def _rates(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    """Derivatives of all states, after `derive`."""
    _, normal_left, normal_right, push_left, push_right = meshes(b)
    derivatives(b, dx, normal_left, normal_right, push_left, push_right, True)


@kernel
def rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    """Derivatives of all states."""
    derive(b)
    _rates(b, t, dx)


@kernel
def motions(b: np.ndarray) -> None:
    """Write positions and velocities at the ports."""
    for i in range(4):
        b[at.S_Y[i]], b[at.V_Y[i]] = b[at.Y + i], b[at.Y + at.RATE + i]
        b[at.S_Z[i]], b[at.V_Z[i]] = b[at.Z + i], b[at.Z + at.RATE + i]
    for order in range(2):
        o = order * at.RATE
        to = at.PHI if order == 0 else at.W
        b[to[0]] = b[at.ANGLE + o] + (1.0 - b[at.SHARE[0]]) * b[at.TWIST_P + o]
        b[to[1]] = wheel(b, order) + (1.0 - b[at.SHARE[1]]) * b[at.TWIST_W + o]


@kernel
def accelerations(b: np.ndarray, dx: np.ndarray) -> None:
    """Write the outputs that depend on the inputs, from the derivatives of the states."""
    for i in range(4):
        b[at.A_Y[i]] = dx[at.Y + at.RATE + i]
        b[at.A_Z[i]] = dx[at.Z + at.RATE + i]
    angle, approach = dx[at.ANGLE + at.RATE], dx[at.APPROACH + at.RATE]
    b[at.A[0]] = angle + (1.0 - b[at.SHARE[0]]) * dx[at.TWIST_P + at.RATE]
    b[at.A[1]] = (b[at.RB[0]] * angle - approach) * b[at.PER_WHEEL_RB] + (
        1.0 - b[at.SHARE[1]]
    ) * dx[at.TWIST_W + at.RATE]


@kernel
def _results(b: np.ndarray, t: float) -> None:
    """Write all outputs, after `derive`."""
    motions(b)
    eps, normal_left, normal_right, push_left, push_right = meshes(b)
    b[at.OFFSET], b[at.FORCE[0]], b[at.FORCE[1]] = eps, normal_left, normal_right
    for side in range(2):
        drive, coast = b[at.DEPTH + 2 * side], b[at.DEPTH + 2 * side + 1]
        b[at.DEFLECTION[side]] = drive if b[at.FLANK] >= 0.0 else -coast - b[at.BACKLASH]
    b[at.TE] = b[at.APPROACH] + 0.5 * (b[at.RB[0]] * b[at.TWIST_P] - b[at.RB[1]] * b[at.TWIST_W])
    dx = b[at.SCRATCH : at.SCRATCH + at.STATES]
    derivatives(b, dx, normal_left, normal_right, push_left, push_right, True)
    accelerations(b, dx)


@kernel
def out(b: np.ndarray, t: float) -> None:
    """Write all outputs."""
    derive(b)
    _results(b, t)


@kernel
def indicators(b: np.ndarray, t: float, z: np.ndarray) -> None:
    """Contact of each mesh: depth on the drive flank, and the gap on the coast flank."""
    derive(b)
    meshes(b)
    for side in range(2):
        z[2 * side], z[2 * side + 1] = b[at.DEPTH + 2 * side], -b[at.DEPTH + 2 * side + 1]


_advance = steppers.body_stepper(_rates, _results, at.DECLARATION, at.SCRATCH, piece)


@kernel
def step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    """Advance by h [s]; add up the times outside the tables and on the other flank."""
    derive(b)
    status = _advance(b, w, t, h, b[at.MICRO_STEP], int(b[at.DEGREE]))
    other = 1 if b[at.FLANK] >= 0.0 else 0
    inside, carried = True, True
    for side in range(2):
        depths = at.DEPTH if b[at.DEVIATIONS] == 0.0 else at.PRESSED
        drive, coast = b[depths + 2 * side], b[depths + 2 * side + 1]
        inside = inside and force_law.inside(
            b, at.TABLE[0] + side * force_law.TABLE_SIZE, max(drive, coast)
        )
        carried = carried and b[depths + 2 * side + other] <= 0.0
    if not inside:
        b[at.OUTSIDE] += h
    if not carried:
        b[at.OTHER_FLANK] += h
    return status
