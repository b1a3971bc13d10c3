"""Declaration of the gear mesh, and where everything lies in its block."""

import math
from itertools import pairwise

from herringbone.components.gear_mesh.variables import VARIABLES
from herringbone.components.ports import HALVES, flange, journals
from herringbone.components.resources import (
    pair_law,
    stiffness_table,
    tooth_deviations,
    transmission_error,
)
from herringbone.core import Declaration, Text
from herringbone.core.declaring.roles import GEARS, Quantity, Role
from herringbone.kernels import force_law, steppers, tooth_pair_law


def _apart(places: tuple[int, ...]) -> int:
    """Distance of places that lie equally far apart."""
    (found,) = {after - before for before, after in pairwise(places)}
    return found


STATES = 24
INPUTS = 10
_DERIVED = 13
_PAIR = 1 + stiffness_table.PAIR[1]
_HELD = 6
_RATIOS = 2
_TABLES = 2 * force_law.TABLE_SIZE + transmission_error.TABLE_SIZE + _PAIR + _HELD
_TEETH = 2 * tooth_pair_law.TABLE_SIZE + tooth_deviations.TABLE_SIZE + _PAIR + _RATIOS
_RESULTS = 18

DECLARATION = Declaration(
    "gear_mesh",
    "Herringbone gear pair: four half-bodies, gap shafts, two meshes (12 degrees of freedom)",
    VARIABLES,
    texts=[
        Text(
            "stiffness_table",
            "stiffness table of both meshes, CSV",
            "mesh_stiffness.csv",
            stiffness_table.COLUMNS,
            Quantity.STIFFNESS_TABLE,
            header=stiffness_table.PAIR[0],
            header_count=stiffness_table.PAIR[1],
        ),
        Text(
            "tooth_errors",
            "given transmission error, CSV of harmonics",
            "perfect_teeth.csv",
            transmission_error.COLUMNS,
            Quantity.TOOTH_ERRORS,
        ),
        Text(
            "tooth_deviations",
            "deviations of single teeth, CSV",
            "ideal_teeth.csv",
            tooth_deviations.COLUMNS,
            Quantity.TOOTH_DEVIATIONS,
        ),
        Text(
            "pair_law",
            "force law of one pair of teeth, CSV; needed with tooth_deviations",
            "no_pair_law.csv",
            pair_law.COLUMNS,
            Quantity.PAIR_LAW,
            header=pair_law.HEADER[0],
            header_count=pair_law.HEADER[1],
        ),
    ],
    tables=_TABLES + _TEETH + STATES + _DERIVED + _RESULTS,
    work=steppers.body_work(STATES, INPUTS),
    roles=[Role.GEAR_PAIR],
    ports=[*journals(), *(flange(gear, gear) for gear in GEARS)],
)

_d = DECLARATION
_i = _d.index
RATE = 12
"""A rate lies this far behind its position."""
Y, Z = _i["y_1"], _i["z_1"]
ANGLE, TWIST_P, APPROACH, TWIST_W = _d.indices("angle", "pinion_twist", "approach", "wheel_twist")
F_Y = _d.indices(*(f"{h}.f_y" for h in HALVES))
F_Z = _d.indices(*(f"{h}.f_z" for h in HALVES))
S_Y, V_Y, A_Y, S_Z, V_Z, A_Z = (
    _d.indices(*(f"{h}.{q}" for h in HALVES)) for q in ("s_y", "v_y", "a_y", "s_z", "v_z", "a_z")
)
TAU, PHI, W, A = (_d.indices(*(f"{g}.{q}" for g in GEARS)) for q in ("tau", "phi", "w", "a"))
RB, MASSES, INERTIAS, K_Y, K_Z, K_T, C_Y, C_Z, C_T, SHARE, TEETH, UNBALANCE, UNBALANCE_PHASE = (
    _d.indices(*(f"{g}.{q}" for g in GEARS))
    for q in (
        "base_radius", "mass", "inertia", "shaft_stiffness_y", "shaft_stiffness_z",
        "shaft_stiffness_t", "shaft_damping_y", "shaft_damping_z", "shaft_damping_t",
        "torque_share_left", "number_of_teeth",
        "unbalance", "unbalance_phase",
    )
)  # fmt: skip
# A tuple's index is checked wherever a loop is not unrolled; distances need no check.
HALF, GEAR, FLANGE = _apart(F_Y), _apart(RB), _apart(TAU)
"""How far apart lie the forces of the halves, the parameters of the gears, the flanges' torques."""
FORCE = _d.indices("mesh_left.force", "mesh_right.force")
DEFLECTION = _d.indices("mesh_left.deflection", "mesh_right.deflection")
TE, OFFSET, OUTSIDE, OTHER_FLANK, PAIR_KNOWN, RAMP_FROM = _d.indices(
    "transmission_error",
    "axial_offset",
    "time_outside_table",
    "time_on_other_flank",
    "table_of_this_pair",
    "first_angle",
)
BETA, ZETA, TRANSITION, GATE, BACKLASH, FLANK, COAST_PHASE, CONTACT_RATIO, STAGGER = _d.indices(
    "base_helix_angle", "mesh_damping_ratio", "damping_transition", "damping_gate", "backlash",
    "flank", "coast_phase", "total_contact_ratio", "stagger",
)  # fmt: skip
F_A, C0, C1, C2, PHI1, PHI2 = _d.indices(
    "symmetry_deviation", "symmetry_constant", "symmetry_pinion", "symmetry_wheel",
    "symmetry_pinion_phase", "symmetry_wheel_phase",
)  # fmt: skip
IMPACT, IMPACT_DURATION, RESTRAINT, AXIAL_DRAG, DRAG, RAMP_TURNS, MICRO_STEP = _d.indices(
    "impact_force", "impact_duration", "pinion_restraint", "pinion_axial_drag", "drag_torque",
    "ramp_turns", "micro_step",
)  # fmt: skip
FACE_WIDTH = _i["face_width"]
DEGREE = _i["interface_degree"]

TABLE = (_d.first_table, _d.first_table + force_law.TABLE_SIZE)
"""Force laws of the left and the right mesh."""
ERRORS = TABLE[1] + force_law.TABLE_SIZE
"""The given transmission error."""
PAIR = ERRORS + transmission_error.TABLE_SIZE
"""1 if the table tells its pair, then the pair: see `stiffness_table`."""
HELD = PAIR + _PAIR
"""Zero unless the meshes are frozen: by side dU/d(phase) [J], by body torque [N m]."""
LAW = (HELD + _HELD, HELD + _HELD + tooth_pair_law.TABLE_SIZE)
"""Force laws of a pair of teeth, left and right."""
DEVIATIONS = LAW[1] + tooth_pair_law.TABLE_SIZE
"""The deviations of single teeth."""
LAW_PAIR = DEVIATIONS + tooth_deviations.TABLE_SIZE
"""1 if there is a law of a pair of teeth, then the pair it is of."""
TRANSVERSE, OVERLAP = LAW_PAIR + _PAIR, LAW_PAIR + _PAIR + 1
"""Contact ratios of that pair."""
SCRATCH = OVERLAP + 1
"""Room for the derivatives of all states."""

_derived = SCRATCH + STATES
COS, SIN, TAN = _derived, _derived + 1, _derived + 2
"""Of the base helix angle."""
PHASE_RATE, AXIAL_PHASE, PER_PITCH = _derived + 3, _derived + 4, _derived + 5
"""Mesh periods per angle [1/rad] and axial shift [1/m] of a pinion half; transverse 1 / p_bt."""
PATH_MASS, PER_TRANSITION, PER_WHEEL_RB = _derived + 6, _derived + 7, _derived + 8
"""Mass [kg] of both rotations along the path of contact; reciprocals."""
PER_MASS, PER_INERTIA = (_derived + 9, _derived + 10), (_derived + 11, _derived + 12)

_results = _derived + _DERIVED
DEPTH = _results
"""By side, drive flank, then coast flank: how deep the flanks are in each other [m]."""
PRESSED = _results + 4
"""In the order of the depths, if teeth deviate: mean depth where they press [m]."""
TORQUE = _results + 8
"""By body: torque [N m] of what moves the flanks by a rotation."""
TANGENT = _results + 12
"""In the order of the depths: tangent stiffness [N/m] of flanks that press."""
NORMAL = _results + 16
"""By side: normal force [N]."""

TWO_PI = 2.0 * math.pi
