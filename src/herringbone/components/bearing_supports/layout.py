"""Declaration of the bearings, with what follows from the gear pair, and places in their block."""

import math
from collections.abc import Mapping

from herringbone.components.ports import HALVES, journals, seats
from herringbone.components.shipped_pair import SHIPPED_PAIR
from herringbone.core import Declaration, Variable, input_, output, parameter
from herringbone.core.declaring.pair_values import PairValues
from herringbone.core.declaring.roles import GEARS, Quantity, Role
from herringbone.kernels import steppers

_RADIAL_STIFFNESS = 6.34e8
_AXIAL_STIFFNESS = {"pinion": 0.0, "wheel": 2.03e8}


def of_pair(pair: PairValues, own: Mapping[str, float]) -> dict[str, float]:
    """Line of action, and damping of the pair's halves on the bearings; see `Component.of_pair`."""
    found = {"pressure_angle": pair.working_pressure_angle}
    for gear, name in enumerate(GEARS):
        for q in ("radial", "axial"):
            stiffness = own[f"{name}.{q}_stiffness"]
            found[f"{name}.{q}_damping"] = pair.bearing_damping(gear, stiffness)
    return found


_SHIPPED = of_pair(
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
        parameter(
            f"{gear}.radial_clearance",
            "m",
            "diametral clearance",
            0.0,
            minimum=0,
            quantity=Quantity.CLEARANCE,
            place=gear,
        ),
    ]


_INPUTS = 10 * len(HALVES)

DECLARATION = Declaration(
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
    DECLARATION.indices(*(f"shaft.{h}.{q}" for h in HALVES)) for q in ("s_y", "v_y", "s_z", "v_z")
)
_SEAT = tuple(
    DECLARATION.indices(*(f"seat.{h}.{q}" for h in HALVES))
    for q in ("s_x", "v_x", "s_y", "v_y", "s_z", "v_z")
)
S_Y, V_Y, S_Z, V_Z = _SHAFT
SEAT_S_X, SEAT_V_X, SEAT_S_Y, SEAT_V_Y, SEAT_S_Z, SEAT_V_Z = _SEAT
F_Y, F_Z = (DECLARATION.indices(*(f"shaft.{h}.{q}" for h in HALVES)) for q in ("f_y", "f_z"))
SEAT_F_X, SEAT_F_Y, SEAT_F_Z = (
    DECLARATION.indices(*(f"seat.{h}.{q}" for h in HALVES)) for q in ("f_x", "f_y", "f_z")
)
K_R, C_R, K_A, C_A, CLEARANCE = (
    DECLARATION.indices(*(f"{g}.{q}" for g in GEARS))
    for q in (
        "radial_stiffness",
        "radial_damping",
        "axial_stiffness",
        "axial_damping",
        "radial_clearance",
    )
)
PER_SHAFT, MOTION, ANGLE, FLANK, DEGREE = DECLARATION.indices(
    "axial_per_shaft", "seat_motion", "pressure_angle", "flank", "interface_degree"
)
