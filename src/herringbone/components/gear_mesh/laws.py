"""The contact of both meshes as laws, apart from the linear rest.

Whatever the meshes do (run-outs, given errors, deviations of single teeth, impact, the ramp)
follows from the relative motions of the halves and from the angles alone: these are the arguments.
"""

import math
from fractions import Fraction

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.gear_mesh import motion
from herringbone.components.gear_mesh.contact import derive, meshes
from herringbone.components.gear_mesh.harmonics import keep_harmonics
from herringbone.components.gear_mesh.period import ramp, settle, turns
from herringbone.components.gear_mesh.toothed_mesh import SOFT
from herringbone.components.resources import tooth_deviations
from herringbone.core import Laws
from herringbone.core.declaring.roles import GEARS
from herringbone.kernels import force_law
from herringbone.kernels.compiling.jit import kernel

_RELATIVE = 4  # differences of y and z of both sides; then angle, twists and approach
_POSITIONS = 8
_PATH, _AXIS, _TURN = 0, 2, 4
_ANGLE, _TWIST_P, _APPROACH, _TWIST_W = (
    _TURN + place - at.ANGLE for place in (at.ANGLE, at.TWIST_P, at.APPROACH, at.TWIST_W)
)
_KINKS = 6  # of a side
_BENT = 0.25
"""Share of the table's limit at which mean tangents are taken."""


@kernel
def _gather(b: np.ndarray, z: np.ndarray) -> None:
    for order in range(2):
        o, first = order * at.RATE, order * _POSITIONS
        for side in range(2):
            z[first + _PATH + side] = b[at.Y + side + o] - b[at.Y + 2 + side + o]
            z[first + _AXIS + side] = b[at.Z + side + o] - b[at.Z + 2 + side + o]
        for i in range(_RELATIVE):
            z[first + _TURN + i] = b[at.ANGLE + i + o]


@kernel
def _place(b: np.ndarray, z: np.ndarray) -> None:
    """Write states that have these arguments: the wheel's halves rest."""
    for order in range(2):
        o, first = order * at.RATE, order * _POSITIONS
        for side in range(2):
            b[at.Y + side + o], b[at.Y + 2 + side + o] = z[first + _PATH + side], 0.0
            b[at.Z + side + o], b[at.Z + 2 + side + o] = z[first + _AXIS + side], 0.0
        for i in range(_RELATIVE):
            b[at.ANGLE + i + o] = z[first + _TURN + i]


@kernel
def _tangent(b: np.ndarray, side: int, flank: int, carries: bool) -> tuple[float, float, float]:
    """Tangent stiffness [N/m] and damping [N s/m] of a flank, and its depth past the gate [m]."""
    depth = b[at.DEPTH + 2 * side + flank]
    if tooth_deviations.given(b, at.DEVIATIONS, side, flank):
        depth = b[at.PRESSED + 2 * side + flank]
    past = depth - 1.0 / b[at.PER_TRANSITION]
    if not carries:
        return 0.0, 0.0, past
    stiffness = b[at.TANGENT + 2 * side + flank]
    g = max(0.0, min(1.0, depth * b[at.PER_TRANSITION]))
    g *= g * (3.0 - 2.0 * g)
    if b[at.GATE] == 0.0:
        g = 1.0
    # Of teeth that touch by an edge alone the spline's tangent may lie below zero.
    damping = 2.0 * g * b[at.ZETA] * math.sqrt(max(stiffness, SOFT) * b[at.PATH_MASS])
    return stiffness, damping, past


@kernel
def _evaluate(b: np.ndarray, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray) -> None:
    _place(b, z)
    _, f[0], f[1], push_left, push_right = meshes(b)
    f[2], f[3] = push_left - b[at.COS] * f[0], push_right - b[at.COS] * f[1]
    if b[at.DRAG] > 0.0:
        w = b[at.ANGLE + at.RATE]
        b[at.TORQUE] -= motion.drag(b, w)
        b[at.TORQUE + 1] -= motion.drag(b, w + b[at.TWIST_P + at.RATE])
    for i in range(2):  # differences, as they vanish where both sides are alike
        f[4 + 2 * i] = b[at.TORQUE + 2 * i]
        f[5 + 2 * i] = b[at.TORQUE + 1 + 2 * i] - b[at.TORQUE + 2 * i]
    gated = b[at.GATE] != 0.0
    for side in range(2):
        k[side], k[2 + side] = 0.0, 0.0
        for flank in range(2):
            depth = b[at.DEPTH + 2 * side + flank]
            pressed = f[side] > 0.0 if flank == 0 else f[side] < 0.0
            stiffness, damping, past = _tangent(b, side, flank, pressed)
            k[side] += stiffness
            k[2 + side] += damping
            place = _KINKS * side + flank
            e[place] = 1.0 if pressed or not gated else -1.0
            e[place + 2] = past if gated else 1.0
            e[place + 4] = depth  # smooth, so that a contact between two places is seen in it


@kernel
def _apply(b: np.ndarray, t: float, f: np.ndarray, dx: np.ndarray) -> None:
    for i in range(2):
        b[at.TORQUE + 2 * i] = f[4 + 2 * i]
        b[at.TORQUE + 1 + 2 * i] = f[4 + 2 * i] + f[5 + 2 * i]
    push_left, push_right = f[2] + b[at.COS] * f[0], f[3] + b[at.COS] * f[1]
    motion.motions(b)
    motion.derivatives(b, dx, f[0], f[1], push_left, push_right, False)
    motion.accelerations(b, dx)


def _directions(block: np.ndarray) -> np.ndarray:
    """Rigid approach of the flanks, left and right, without run-out; then its rate."""
    rows = np.zeros((4, 2 * _POSITIONS))
    beta = float(block[at.BETA])
    for side in range(2):
        row = np.zeros(_POSITIONS)
        row[_PATH + side] = row[_APPROACH] = math.cos(beta)
        row[_AXIS + side] = (1.0 - 2.0 * side) * math.sin(beta)
        row[_TWIST_P] = side * math.cos(beta) * block[at.RB[0]]
        row[_TWIST_W] = -side * math.cos(beta) * block[at.RB[1]]
        rows[side, :_POSITIONS] = rows[2 + side, _POSITIONS:] = row
    return rows


def _phases(block: np.ndarray) -> np.ndarray:
    """Phases of the meshes, left and right, without run-out."""
    prepared = block.copy()
    derive(prepared)
    rows = np.zeros((2, 2 * _POSITIONS))
    for side in range(2):
        rows[side, _ANGLE] = prepared[at.PHASE_RATE]
        rows[side, _TWIST_P] = side * prepared[at.PHASE_RATE]
        rows[side, _AXIS + side] = (1.0 - 2.0 * side) * prepared[at.AXIAL_PHASE]
    return rows


def _mean(block: np.ndarray) -> np.ndarray:
    """Means over a mesh period, at a share of the deflection that the tables reach."""
    prepared = block.copy()
    derive(prepared)
    phases = np.arange(force_law.PHASES) / force_law.PHASES
    stiffness = np.array([
        np.mean([force_law.law(prepared, table, p, _BENT * prepared[table])[1] for p in phases])
        for table in at.TABLE
    ])  # fmt: skip
    damping = 2.0 * prepared[at.ZETA] * np.sqrt(stiffness * prepared[at.PATH_MASS])
    return np.concatenate([stiffness, damping])


def _periods(block: np.ndarray) -> tuple[tuple[int, Fraction], ...]:
    return tuple((_TURN, turn) for turn in turns(block))


def _refusal(block: np.ndarray) -> str:
    for gear, name in enumerate(GEARS):
        unbalance = block[at.UNBALANCE[0] + gear * at.GEAR]
        if unbalance > 0.0:
            return f"{name}.unbalance = {unbalance:g} kg.m makes its masses depend on the angle"
    return ""


_MOTIONS = (
    "y of the left halves", "y of the right halves",
    "z of the left halves", "z of the right halves",
    "angle", "pinion_twist", "approach", "wheel_twist",
)  # fmt: skip
LAWS = Laws(
    arguments=(*_MOTIONS, *(f"der({name})" for name in _MOTIONS)),
    values=(
        "normal force left", "normal force right", "push by phase left", "push by phase right",
        "torque 1", "torque 2 - torque 1", "torque 3", "torque 4 - torque 3",
    ),
    stiff=(0, 1, 0, 1),
    kinks=2 * _KINKS,
    gather=_gather,
    evaluate=_evaluate,
    apply=_apply,
    directions=_directions,
    mean=_mean,
    prepare=derive,
    refusal=_refusal,
    fine=_phases,
    periods=_periods,
    settle=settle,
    ramp=ramp,
    keep_harmonics=keep_harmonics,
)  # fmt: skip
