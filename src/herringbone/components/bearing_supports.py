r"""Massless bearings of the four gear halves, between shaft (gear frame) and seat (housing frame).

The gear's y is the line of action of the flank that carries. In the housing frame (x toward the
wheel, y up, z axial) it is the unit vector n = (flank sin(alpha_wt), cos(alpha_wt), 0), for a
pinion whose driving rotation is about +z; flank is 1 (drive) or -1 (coast), the same as at the
gear. With the seat motion projected on n, each half has

    d = s_y - n . s_seat,   f = radial_stiffness gap(d) + radial_damping g d'
    force on the shaft: -f along y;   force on the seat: +f n

and the same along z with the axial stiffness, without n. The same vector carries motion in and
force out, so that no power is created. With a radial clearance c,

    gap(d) = d - max(-c/2, min(d, c/2)),   g = min(1, |gap(d)| / (c/10))

so that the damping acts only on the loaded part, and f = 0 where its sign is not that of gap(d): a
bearing with clearance never pulls. Without clearance g = 1, and f may have any sign.

With `seat_motion` 0 the bearings stand on rigid ground: s_seat and its rate count as zero, while
the forces drive the housing as before. This is the one-way procedure of the thesis, chapter 4.
Power is not balanced then: what the housing takes up nobody has given.

A master that steps all FMUs in parallel sees this element one macro step h late; gear and seat then
are stable only for h < 4/3 zeta / w with the local w, zeta; `herringbone stability` computes the
limit of a system. A master that steps it after the bodies, over the same interval, has no delay.

Source: the thesis, table 3.1 (radial 6.34e8 N/m, axial 2.03e8 N/m, read as per half of the wheel);
damping 2 % of the local critical damping of a half-body, a choice of this project.
"""

import math
from collections.abc import Mapping

import numpy as np

from herringbone.components.ports import HALVES, journals, seats
from herringbone.components.shipped_pair import SHIPPED_PAIR
from herringbone.core import (
    Component,
    Declaration,
    Kernels,
    Laws,
    Variable,
    input_,
    output,
    parameter,
)
from herringbone.core.declaring.pair_values import PairValues
from herringbone.core.declaring.roles import GEARS, Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.elementary import cosine, sine

_RADIAL_STIFFNESS = 6.34e8
_AXIAL_STIFFNESS = {"pinion": 0.0, "wheel": 2.03e8}


def _of_pair(pair: PairValues, own: Mapping[str, float]) -> dict[str, float]:
    """Line of action, and damping of the pair's halves on the bearings; see `Component.of_pair`."""
    found = {"pressure_angle": pair.working_pressure_angle}
    for gear, name in enumerate(GEARS):
        for q in ("radial", "axial"):
            stiffness = own[f"{name}.{q}_stiffness"]
            found[f"{name}.{q}_damping"] = pair.bearing_damping(gear, stiffness)
    return found


_SHIPPED = _of_pair(
    SHIPPED_PAIR,
    {f"{g}.radial_stiffness": _RADIAL_STIFFNESS for g in GEARS}
    | {f"{g}.axial_stiffness": _AXIAL_STIFFNESS[g] for g in GEARS},
)


def _ports(half: str) -> list[Variable]:
    radial = tuple(f"{p}.{q}" for p in (f"shaft.{half}",) for q in ("s_y", "v_y")) + tuple(
        f"seat.{half}.{q}" for q in ("s_x", "v_x", "s_y", "v_y")
    )
    axial = tuple(f"{side}.{half}.{q}" for side in ("shaft", "seat") for q in ("s_z", "v_z"))
    unit = {"s": "m", "v": "m/s"}
    what = {"s": "position", "v": "velocity"}
    motion = [
        input_(f"{side}.{half}.{q}_{axis}", unit[q], f"{what[q]} of the {side} at {half}, {axis}")
        for side, axes in (("shaft", "yz"), ("seat", "xyz"))
        for axis in axes
        for q in "sv"
    ]
    forces = [
        output(
            f"{side}.{half}.f_{axis}",
            "N",
            f"force on the {side} at {half} along {axis}",
            feedthrough=axial if axis == "z" else radial,
            nodes=True,
        )
        for side, axes in (("shaft", "yz"), ("seat", "xyz"))
        for axis in axes
    ]
    return motion + forces


def _parameters(gear: str) -> list[Variable]:
    stiffness, damping = Quantity.STIFFNESS, Quantity.DAMPING
    of_radial, of_axial = (_SHIPPED[f"{gear}.{q}_damping"] for q in ("radial", "axial"))
    rows = (
        ("radial_stiffness", "N/m", "per half", _RADIAL_STIFFNESS, stiffness),
        ("radial_damping", "N.s/m", "per half", of_radial, damping),
        ("axial_stiffness", "N/m", "see axial_per_shaft", _AXIAL_STIFFNESS[gear], stiffness),
        ("axial_damping", "N.s/m", "as axial_stiffness", of_axial, damping),
    )
    return [
        *(
            parameter(f"{gear}.{name}", unit, told, start, minimum=0, quantity=what, place=gear)
            for name, unit, told, start, what in rows
        ),
        parameter(f"{gear}.radial_clearance", "m", "diametral clearance", 0.0, minimum=0),
    ]


_INPUTS = 10 * len(HALVES)

_d = Declaration(
    "bearing_supports",
    "Massless bearings of the four gear halves, between line of action and housing frame",
    [
        *(v for half in HALVES for v in _ports(half)),
        *(v for gear in GEARS for v in _parameters(gear)),
        parameter(
            "axial_per_shaft",
            "1",
            "0: axial values are per half, 1: per shaft, half of it at each half",
            0.0,
            minimum=0,
            maximum=1,
        ),
        parameter(
            "seat_motion",
            "1",
            "1: the seats move the bearings, 0: bearings on rigid ground, housing driven one way",
            1.0,
            minimum=0,
            maximum=1,
            whole=True,
            quantity=Quantity.SEAT_MOTION,
        ),
        parameter(
            "pressure_angle",
            "rad",
            "working transverse pressure angle alpha_wt",
            _SHIPPED["pressure_angle"],
            minimum=-math.pi,
            maximum=math.pi,
            quantity=Quantity.WORKING_PRESSURE_ANGLE,
        ),
        parameter(
            "flank",
            "1",
            "whose line of action y is: -1 that of the coast flank, else the drive flank's",
            1.0,
            minimum=-1,
            maximum=1,
            whole=True,
            quantity=Quantity.CARRYING_FLANK,
        ),
    ],
    work=steppers.element_work(_INPUTS),
    roles=[Role.BEARING],
    ports=[*journals("shaft."), *seats("seat.")],
)

_SHAFT = tuple(
    _d.indices(*(f"shaft.{h}.{q}" for h in HALVES)) for q in ("s_y", "v_y", "s_z", "v_z")
)
_SEAT = tuple(
    _d.indices(*(f"seat.{h}.{q}" for h in HALVES))
    for q in ("s_x", "v_x", "s_y", "v_y", "s_z", "v_z")
)
_S_Y, _V_Y, _S_Z, _V_Z = _SHAFT
_SEAT_S_X, _SEAT_V_X, _SEAT_S_Y, _SEAT_V_Y, _SEAT_S_Z, _SEAT_V_Z = _SEAT
_F_Y, _F_Z = (_d.indices(*(f"shaft.{h}.{q}" for h in HALVES)) for q in ("f_y", "f_z"))
_SEAT_F_X, _SEAT_F_Y, _SEAT_F_Z = (
    _d.indices(*(f"seat.{h}.{q}" for h in HALVES)) for q in ("f_x", "f_y", "f_z")
)
_K_R, _C_R, _K_A, _C_A, _CLEARANCE = (
    _d.indices(*(f"{g}.{q}" for g in GEARS))
    for q in (
        "radial_stiffness",
        "radial_damping",
        "axial_stiffness",
        "axial_damping",
        "radial_clearance",
    )
)
_PER_SHAFT, _MOTION, _ANGLE, _FLANK, _DEGREE = _d.indices(
    "axial_per_shaft", "seat_motion", "pressure_angle", "flank", "interface_degree"
)


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    pass


@kernel
def _radial(b: np.ndarray, gear: int, d: float, rate: float) -> float:
    """Radial bearing force [N] at relative displacement d [m] and its rate [m/s]."""
    play = 0.5 * b[_CLEARANCE[gear]]
    loaded = d - max(-play, min(d, play))
    if play == 0.0:
        return b[_K_R[gear]] * d + b[_C_R[gear]] * rate
    g = min(1.0, abs(loaded) / (0.2 * play))
    force = b[_K_R[gear]] * loaded + b[_C_R[gear]] * g * rate
    return max(0.0, force) if loaded > 0.0 else min(0.0, force)


@kernel
def _line_of_action(b: np.ndarray) -> tuple[float, float]:
    """Its unit vector in the housing frame."""
    n_x, n_y = sine(b[_ANGLE]), cosine(b[_ANGLE])
    return -n_x if b[_FLANK] < 0.0 else n_x, n_y


@kernel
def _approach(b: np.ndarray, i: int, n_x: float, n_y: float) -> tuple[float, float]:
    """Radial displacement of a half against its seat [m], and its rate [m/s]."""
    m = b[_MOTION]
    d = b[_S_Y[i]] - m * (n_x * b[_SEAT_S_X[i]] + n_y * b[_SEAT_S_Y[i]])
    return d, b[_V_Y[i]] - m * (n_x * b[_SEAT_V_X[i]] + n_y * b[_SEAT_V_Y[i]])


@kernel
def _forces(b: np.ndarray, i: int, n_x: float, n_y: float, radial: float) -> None:
    """Write the forces of a half's bearing with a given radial force [N]."""
    gear, m = i // 2, b[_MOTION]
    b[_F_Y[i]] = -radial
    b[_SEAT_F_X[i]], b[_SEAT_F_Y[i]] = radial * n_x, radial * n_y
    axial = b[_K_A[gear]] * (b[_S_Z[i]] - m * b[_SEAT_S_Z[i]])
    axial += b[_C_A[gear]] * (b[_V_Z[i]] - m * b[_SEAT_V_Z[i]])
    axial *= 1.0 - 0.5 * b[_PER_SHAFT]
    b[_F_Z[i]], b[_SEAT_F_Z[i]] = -axial, axial


@kernel
def _out(b: np.ndarray, t: float) -> None:
    n_x, n_y = _line_of_action(b)
    for i in range(4):
        d, rate = _approach(b, i, n_x, n_y)
        _forces(b, i, n_x, n_y, _radial(b, i // 2, d, rate))


_advance = steppers.element_stepper(_out, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, int(b[_DEGREE]))


@kernel
def _gather(b: np.ndarray, z: np.ndarray) -> None:
    n_x, n_y = _line_of_action(b)
    for i in range(4):
        z[i], z[4 + i] = _approach(b, i, n_x, n_y)


@kernel
def _evaluate(b: np.ndarray, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray) -> None:
    for i in range(4):
        gear, d = i // 2, z[i]
        play = 0.5 * b[_CLEARANCE[gear]]
        loaded = abs(d) - play
        f[i] = _radial(b, gear, d, z[4 + i])
        carries = play == 0.0 or f[i] != 0.0
        k[i] = b[_K_R[gear]] if carries else 0.0
        g = max(0.0, min(1.0, loaded / (0.2 * play))) if play > 0.0 else 1.0
        k[4 + i] = b[_C_R[gear]] * g if carries else 0.0
        e[i] = 1.0 if carries else -1.0
        e[4 + i] = loaded - 0.2 * play if play > 0.0 else 1.0


@kernel
def _apply(b: np.ndarray, t: float, f: np.ndarray, dx: np.ndarray) -> None:
    n_x, n_y = _line_of_action(b)
    for i in range(4):
        _forces(b, i, n_x, n_y, f[i])


def _each(block: np.ndarray) -> np.ndarray:
    """Stiffness along the displacement, damping along its rate."""
    del block
    return np.eye(8)


def _without_play(block: np.ndarray) -> np.ndarray:
    """Stiffness [N/m] and damping [N s/m] of loaded bearings."""
    return np.array([block[places[i // 2]] for places in (_K_R, _C_R) for i in range(4)])


def _has_play(block: np.ndarray) -> bool:
    return any(block[i] > 0.0 for i in _CLEARANCE)


_LAWS = Laws(
    arguments=tuple(
        f"{what} at {half}" for what in ("displacement", "its rate") for half in HALVES
    ),
    values=tuple(f"radial force at {half}" for half in HALVES),
    stiff=(0, 1, 2, 3, 0, 1, 2, 3),
    kinks=8,
    gather=_gather,
    evaluate=_evaluate,
    apply=_apply,
    directions=_each,
    mean=_without_play,
    needed=_has_play,
)

BEARING_SUPPORTS = Component(_d, Kernels(_step, _rhs, _out), __doc__, of_pair=_of_pair, laws=_LAWS)
