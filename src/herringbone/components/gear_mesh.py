r"""Herringbone gear pair: four half-bodies, two gap shafts, two meshes, 12 degrees of freedom.

**Bodies.** 1 pinion left, 2 pinion right, 3 wheel left, 4 wheel right; each moves along the line
of action (y), along the axis (z) and about it (theta). y points where the driving pinion flank
pushes the wheel; z from the right half to the left one; rotations are positive in driving sense, so
that a positive rotation of either gear moves its flank to +y. s = +1 left, -1 right; beta_b is the
base helix angle.

**Deflection** of the meshes, normal to the flank, compression positive:

    delta_L = cos(beta_b) (y1 - y3 + rb1 theta1 - rb2 theta3) + sin(beta_b) (z1 - z3 + eps_z)
    delta_R = cos(beta_b) (y2 - y4 + rb1 theta2 - rb2 theta4) - sin(beta_b) (z2 - z4 + eps_z)

    eps_z = f_A (c0 + c1 cos(theta1 + phi1) + c2 cos(theta3 + phi2))

f_A is the symmetry deviation: the axial offset of the chevron's apex, with a constant part and the
run-outs of pinion and wheel. It also shifts the contact lines by +-f_A tan(beta_b) / p_bt of a mesh
period. It is never inside the stiffness table.

**Normal force** from the force law F of the table (see `kernels.force_law`), with its tangent k:

    drive side, delta > 0:          N = max(0,  F(p, delta) + C g delta')
    open,   -backlash <= delta <= 0: N = 0
    coast side, e = -backlash - delta > 0:  N = min(0, -F(p, e) + C g delta')

    C = 2 zeta sqrt(k m_e),   m_e = 1 / (rb1^2 / I_pinion + rb2^2 / I_wheel)

This is the corrected form of the thesis' mesh damping, whose base radii are swapped; g rises
smoothly from 0 to 1 over `damping_transition`, so that no force jumps at contact. The phase p
counts mesh periods of the pinion's left half; the right half is ahead by `stagger`. An optional
meshing impact adds a raised-cosine pulse at the start of each mesh period, inside N, on the drive
side.

**Equations of motion** (virtual work; left pair 1-3, right pair 2-4; f, tau are the inputs):

    m y1'' = f_y1 - k_y (y1 - y2) - c_y (y1' - y2') - cos(beta_b) N_L       (wheel: + cos(beta_b) N)
    m z1'' = f_z1 - k_z (z1 - z2) - c_z (z1' - z2') - s sin(beta_b) N_L - restraint
    I theta1'' = share tau + k_t (theta2 - theta1) + c_t (theta2' - theta1') - rb1 cos(beta_b) N_L

`restraint` holds the pinion axially against ground, at the mean of its halves (0: it floats), and
`pinion_axial_drag` damps each half. States are the angle of body 1,
the twists theta2 - theta1 and theta4 - theta3, and rb1 theta1 - rb2 theta3 ("approach"), so that
precision does not decay with the number of revolutions. A flange moves with the mean of its two
halves, weighted by their torque shares: otherwise power would be created.

**Integration**: classical Runge-Kutta with `micro_step`. The default keeps the error of the bearing
forces below 1e-4 also when teeth separate. On the test rig, against micro steps of 0.3 us:

    micro step      2.5 us    3.3 us    5 us      10 us
    loaded teeth    3.7e-8    1.2e-7    5.9e-7    9.4e-6
    separation      5.8e-5    4.4e-5    1.7e-4    1.4e-4

**Limits.** Only the drive-side line of action is modelled: on coast contact the direction of the
separating force is wrong. No friction, no tilting of the bodies.

Sources: the thesis, chapter 3, with the corrections derived from virtual work. Geometry, masses,
shaft stiffnesses and the stiffness table are those of the pair in `gear_pair.toml`; `herringbone
gear` computes them, and those of other pairs.
"""

import math

import numpy as np

from herringbone.components.frozen_mesh import freeze_mesh
from herringbone.components.gear_mesh_variables import VARIABLES
from herringbone.components.ports import HALVES, flange, journals
from herringbone.components.resources import stiffness_table
from herringbone.components.resources.loader import ResourceLoader
from herringbone.core import Component, Declaration, Kernels, Text
from herringbone.core.roles import GEARS, Role
from herringbone.kernels import force_law, steppers
from herringbone.kernels.elementary import cosine, sine, sine_and_cosine
from herringbone.kernels.jit import kernel

_STATES = 24
_INPUTS = 10
_DERIVED = 12

_d = Declaration(
    "gear_mesh",
    "Herringbone gear pair: four half-bodies, gap shafts, two meshes (12 degrees of freedom)",
    VARIABLES,
    texts=[
        Text(
            "stiffness_table",
            "stiffness table of both meshes, CSV",
            "mesh_stiffness.csv",
            stiffness_table.COLUMNS,
        )
    ],
    tables=2 * force_law.TABLE_SIZE + _STATES + _DERIVED,
    work=steppers.body_work(_STATES, _INPUTS),
    roles=[Role.GEAR_PAIR],
    ports=[*journals(), *(flange(gear, gear) for gear in GEARS)],
)

_i = _d.index
_HALF = 12  # a rate lies this far behind its position
_Y, _Z = _i["y_1"], _i["z_1"]
_ANGLE, _TWIST_P, _APPROACH, _TWIST_W = _d.indices(
    "angle", "pinion_twist", "approach", "wheel_twist"
)
_F_Y = _d.indices(*(f"{h}.f_y" for h in HALVES))
_F_Z = _d.indices(*(f"{h}.f_z" for h in HALVES))
_S_Y, _V_Y, _A_Y, _S_Z, _V_Z, _A_Z = (
    _d.indices(*(f"{h}.{q}" for h in HALVES)) for q in ("s_y", "v_y", "a_y", "s_z", "v_z", "a_z")
)
_TAU, _PHI, _W, _A = (_d.indices(*(f"{g}.{q}" for g in GEARS)) for q in ("tau", "phi", "w", "a"))
_RB, _MASSES, _INERTIAS, _K_Y, _K_Z, _K_T, _C_Y, _C_Z, _C_T, _SHARE, _TEETH = (
    _d.indices(*(f"{g}.{q}" for g in GEARS))
    for q in (
        "base_radius", "mass", "inertia", "shaft_stiffness_y", "shaft_stiffness_z",
        "shaft_stiffness_t", "shaft_damping_y", "shaft_damping_z", "shaft_damping_t",
        "torque_share_left", "number_of_teeth",
    )
)  # fmt: skip
_FORCE = _d.indices("mesh_left.force", "mesh_right.force")
_DEFLECTION = _d.indices("mesh_left.deflection", "mesh_right.deflection")
_TE, _OFFSET, _OUTSIDE = _d.indices("transmission_error", "axial_offset", "time_outside_table")
_BETA, _ZETA, _TRANSITION, _BACKLASH, _STAGGER = _d.indices(
    "base_helix_angle", "mesh_damping_ratio", "damping_transition", "backlash", "stagger"
)
_F_A, _C0, _C1, _C2, _PHI1, _PHI2 = _d.indices(
    "symmetry_deviation", "symmetry_constant", "symmetry_pinion", "symmetry_wheel",
    "symmetry_pinion_phase", "symmetry_wheel_phase",
)  # fmt: skip
_IMPACT, _IMPACT_DURATION, _RESTRAINT, _AXIAL_DRAG, _DRAG, _MICRO_STEP = _d.indices(
    "impact_force", "impact_duration", "pinion_restraint", "pinion_axial_drag", "drag_torque",
    "micro_step",
)  # fmt: skip
_DEGREE = _i["interface_degree"]
_TABLE = (_d.first_table, _d.first_table + force_law.TABLE_SIZE)
_SCRATCH = _TABLE[1] + force_law.TABLE_SIZE
# What `_derive` writes: cosine and sine of the base helix angle; phase [mesh periods] of the meshes
# at angle zero, and per angle; mass [kg] of both rotations along the path of contact; reciprocals.
_COS = _SCRATCH + _STATES
_SIN, _PHASE_LEFT, _PHASE_RIGHT, _PHASE_RATE, _PATH_MASS = range(_COS + 1, _COS + 6)
_PER_TRANSITION, _PER_WHEEL_RB = _COS + 6, _COS + 7
_PER_MASS, _PER_INERTIA = (_COS + 8, _COS + 9), (_COS + 10, _COS + 11)
_TWO_PI = 2.0 * math.pi
_CLOSED = 5e-6  # a usual deflection [m], where the search for an equilibrium begins


@kernel
def _derive(b: np.ndarray) -> None:
    """Write what follows from the parameters alone."""
    b[_COS], b[_SIN] = cosine(b[_BETA]), sine(b[_BETA])
    b[_PHASE_RATE] = b[_TEETH[0]] / _TWO_PI
    shift = b[_F_A] * b[_SIN] * b[_PHASE_RATE] / (b[_COS] * b[_RB[0]])
    b[_PHASE_LEFT], b[_PHASE_RIGHT] = shift, b[_STAGGER] - shift
    b[_PATH_MASS] = 1.0 / (b[_RB[0]] ** 2 / b[_INERTIAS[0]] + b[_RB[1]] ** 2 / b[_INERTIAS[1]])
    b[_PER_TRANSITION], b[_PER_WHEEL_RB] = 1.0 / b[_TRANSITION], 1.0 / b[_RB[1]]
    for gear in range(2):
        b[_PER_MASS[gear]], b[_PER_INERTIA[gear]] = 1.0 / b[_MASSES[gear]], 1.0 / b[_INERTIAS[gear]]


@kernel
def _wheel(b: np.ndarray, order: int) -> float:
    """Angle [rad] (order 0) or speed [rad/s] (order 1) of the wheel's left half."""
    o = order * _HALF
    return (b[_RB[0]] * b[_ANGLE + o] - b[_APPROACH + o]) * b[_PER_WHEEL_RB]


@kernel
def _axial_offset(b: np.ndarray) -> tuple[float, float]:
    """eps_z [m] and its rate [m/s]."""
    if b[_F_A] == 0.0:
        return 0.0, 0.0
    sin_p, cos_p = sine_and_cosine(b[_ANGLE] + b[_PHI1])
    sin_w, cos_w = sine_and_cosine(_wheel(b, 0) + b[_PHI2])
    offset = b[_C0] + b[_C1] * cos_p + b[_C2] * cos_w
    rate = -b[_C1] * b[_ANGLE + _HALF] * sin_p - b[_C2] * _wheel(b, 1) * sin_w
    return b[_F_A] * offset, b[_F_A] * rate


@kernel
def _deflection(b: np.ndarray, side: int, eps: float, eps_rate: float) -> tuple[float, float]:
    """Deflection [m] and its rate [m/s] of mesh 0 (left) or 1 (right)."""
    s = 1.0 - 2.0 * side
    y, z, turn = _Y + side, _Z + side, side
    path = b[_APPROACH] + turn * (b[_RB[0]] * b[_TWIST_P] - b[_RB[1]] * b[_TWIST_W])
    path_rate = b[_APPROACH + _HALF] + turn * (
        b[_RB[0]] * b[_TWIST_P + _HALF] - b[_RB[1]] * b[_TWIST_W + _HALF]
    )
    value = b[_COS] * (b[y] - b[y + 2] + path) + s * b[_SIN] * (b[z] - b[z + 2] + eps)
    y, z = y + _HALF, z + _HALF
    rate = b[_COS] * (b[y] - b[y + 2] + path_rate) + s * b[_SIN] * (b[z] - b[z + 2] + eps_rate)
    return value, rate


@kernel
def _impact(b: np.ndarray, phase: float) -> float:
    """Force [N] of the meshing impact."""
    into = (phase - math.floor(phase)) / b[_IMPACT_DURATION]
    return 0.5 * b[_IMPACT] * (1.0 - cosine(_TWO_PI * into)) if into < 1.0 else 0.0


@kernel
def _normal_force(b: np.ndarray, side: int, deflection: float, rate: float) -> float:
    """Normal force [N] of a mesh; negative on the coast side."""
    coast = -b[_BACKLASH] - deflection
    if deflection <= 0.0 and coast <= 0.0:
        return 0.0
    s = 1.0 if deflection > 0.0 else -1.0
    depth = deflection if deflection > 0.0 else coast
    phase = b[_PHASE_RATE] * b[_ANGLE] + b[_PHASE_LEFT + side]
    force, tangent = force_law.force_and_tangent(b, _TABLE[side], phase, depth)
    g = min(1.0, depth * b[_PER_TRANSITION])
    g *= g * (3.0 - 2.0 * g)
    if b[_IMPACT] > 0.0 and s > 0.0:
        force += g * _impact(b, phase)
    damping = 2.0 * b[_ZETA] * math.sqrt(tangent * b[_PATH_MASS])
    return s * max(0.0, force + s * damping * g * rate)


@kernel
def _meshes(b: np.ndarray) -> tuple[float, float, float, float, float]:
    """eps_z [m], deflections [m] and normal forces [N] of both meshes."""
    eps, eps_rate = _axial_offset(b)
    left, left_rate = _deflection(b, 0, eps, eps_rate)
    right, right_rate = _deflection(b, 1, eps, eps_rate)
    force_left = _normal_force(b, 0, left, left_rate)
    force_right = _normal_force(b, 1, right, right_rate)
    return eps, left, right, force_left, force_right


@kernel
def _derivatives(b: np.ndarray, dx: np.ndarray, left: float, right: float) -> None:
    """Derivatives of all states under the normal forces of both meshes."""
    for i in range(_HALF):
        dx[i] = b[i + _HALF]
    for gear in range(2):
        sign = -1.0 if gear == 0 else 1.0
        first = 2 * gear
        per_mass, per_inertia, rb = b[_PER_MASS[gear]], b[_PER_INERTIA[gear]], b[_RB[gear]]
        y, z, twist = _Y + first, _Z + first, _TWIST_P + first
        bend = b[_K_Y[gear]] * (b[y] - b[y + 1])
        bend += b[_C_Y[gear]] * (b[y + _HALF] - b[y + 1 + _HALF])
        stretch = b[_K_Z[gear]] * (b[z] - b[z + 1])
        stretch += b[_C_Z[gear]] * (b[z + _HALF] - b[z + 1 + _HALF])
        torsion = b[_K_T[gear]] * b[twist] + b[_C_T[gear]] * b[twist + _HALF]
        path_left, path_right = sign * b[_COS] * left, sign * b[_COS] * right
        dx[y + _HALF] = (b[_F_Y[first]] - bend + path_left) * per_mass
        dx[y + 1 + _HALF] = (b[_F_Y[first + 1]] + bend + path_right) * per_mass
        force_left = b[_F_Z[first]] - stretch + sign * b[_SIN] * left
        force_right = b[_F_Z[first + 1]] + stretch - sign * b[_SIN] * right
        tau, drag = b[_TAU[gear]], 0.0
        if gear == 0:
            hold = 0.25 * b[_RESTRAINT] * (b[z] + b[z + 1])
            force_left -= hold + b[_AXIAL_DRAG] * b[z + _HALF]
            force_right -= hold + b[_AXIAL_DRAG] * b[z + 1 + _HALF]
            if b[_DRAG] > 0.0:
                w = b[_ANGLE + _HALF]
                drag = 0.5 * b[_DRAG] * w / math.sqrt(1.0 + w * w)
        dx[z + _HALF] = force_left * per_mass
        dx[z + 1 + _HALF] = force_right * per_mass
        share = b[_SHARE[gear]]
        turn_left = (share * tau - drag + torsion + rb * path_left) * per_inertia
        turn_right = ((1.0 - share) * tau - drag - torsion + rb * path_right) * per_inertia
        dx[twist + _HALF] = turn_right - turn_left
        if gear == 0:
            dx[_ANGLE + _HALF] = turn_left
            dx[_APPROACH + _HALF] = rb * turn_left
        else:
            dx[_APPROACH + _HALF] -= rb * turn_left


@kernel
def _rates(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    """Derivatives of all states, after `_derive`."""
    _, _, _, left, right = _meshes(b)
    _derivatives(b, dx, left, right)


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    _derive(b)
    _rates(b, t, dx)


@kernel
def _motions(b: np.ndarray) -> None:
    """Write positions and velocities at the ports."""
    for i in range(4):
        b[_S_Y[i]], b[_V_Y[i]] = b[_Y + i], b[_Y + _HALF + i]
        b[_S_Z[i]], b[_V_Z[i]] = b[_Z + i], b[_Z + _HALF + i]
    for o in range(0, _HALF + 1, _HALF):
        at = _PHI if o == 0 else _W
        b[at[0]] = b[_ANGLE + o] + (1.0 - b[_SHARE[0]]) * b[_TWIST_P + o]
        b[at[1]] = _wheel(b, o // _HALF) + (1.0 - b[_SHARE[1]]) * b[_TWIST_W + o]


@kernel
def _accelerations(b: np.ndarray, dx: np.ndarray) -> None:
    """Write the outputs that depend on the inputs, from the derivatives of the states."""
    for i in range(4):
        b[_A_Y[i]] = dx[_Y + _HALF + i]
        b[_A_Z[i]] = dx[_Z + _HALF + i]
    wheel = (b[_RB[0]] * dx[_ANGLE + _HALF] - dx[_APPROACH + _HALF]) * b[_PER_WHEEL_RB]
    b[_A[0]] = dx[_ANGLE + _HALF] + (1.0 - b[_SHARE[0]]) * dx[_TWIST_P + _HALF]
    b[_A[1]] = wheel + (1.0 - b[_SHARE[1]]) * dx[_TWIST_W + _HALF]


@kernel
def _results(b: np.ndarray, t: float) -> None:
    """Write all outputs, after `_derive`."""
    _motions(b)
    eps, left, right, force_left, force_right = _meshes(b)
    b[_OFFSET], b[_DEFLECTION[0]], b[_DEFLECTION[1]] = eps, left, right
    b[_FORCE[0]], b[_FORCE[1]] = force_left, force_right
    b[_TE] = b[_APPROACH] + 0.5 * (b[_RB[0]] * b[_TWIST_P] - b[_RB[1]] * b[_TWIST_W])
    dx = b[_SCRATCH : _SCRATCH + _STATES]
    _derivatives(b, dx, force_left, force_right)
    _accelerations(b, dx)


@kernel
def _out(b: np.ndarray, t: float) -> None:
    _derive(b)
    _results(b, t)


@kernel
def _indicators(b: np.ndarray, t: float, z: np.ndarray) -> None:
    """Contact of each mesh: deflection on the drive side, and past the backlash."""
    _derive(b)
    eps, eps_rate = _axial_offset(b)
    for side in range(2):
        deflection, _ = _deflection(b, side, eps, eps_rate)
        z[2 * side], z[2 * side + 1] = deflection, deflection + b[_BACKLASH]


_advance = steppers.body_stepper(_rates, _results, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    _derive(b)
    status = _advance(b, w, t, h, b[_MICRO_STEP], int(b[_DEGREE]))
    left = force_law.inside(b, _TABLE[0], b[_DEFLECTION[0]])
    right = force_law.inside(b, _TABLE[1], b[_DEFLECTION[1]])
    if not (left and right):
        b[_OUTSIDE] += h
    return status


@kernel
def _load(
    values: np.ndarray, shape: np.ndarray, b: np.ndarray, s: np.ndarray, report: np.ndarray
) -> int:
    """Turn the stiffness table into the force laws of both meshes."""
    for side in range(2):
        refusal, loads, phases = stiffness_table.collect(values, shape[0], side, s, report)
        if refusal:
            return refusal
        stiffness, scratch = s[stiffness_table.GRID :], s[stiffness_table.SCRATCH_SIZE :]
        table = _TABLE[0] + side * force_law.TABLE_SIZE
        force_law.build(s[:loads], stiffness, phases, b, table, scratch)
    return 0


def _guess(block: np.ndarray) -> None:
    """Both meshes closed, whatever the symmetry deviation."""
    offset = abs(block[_F_A]) * math.tan(abs(block[_BETA]))
    block[_APPROACH] = offset + _CLOSED


_LOADER = ResourceLoader(
    _d.texts,
    _load,
    stiffness_table.REFUSALS,
    stiffness_table.SCRATCH_SIZE + force_law.SCRATCH_SIZE,
)

GEAR_MESH = Component(
    _d,
    Kernels(_step, _rhs, _out),
    __doc__,
    load=_LOADER,
    guess=_guess,
    indicators=_indicators,
    indicator_count=4,
    longest_step=steppers.longest_step(_d, "micro_step"),
    freeze=freeze_mesh,
)
