"""What a component is for: roles, kinds of ports, and the quantities that a role is asked for.

A component declares them; analysis, reports and pictures ask for them, never for a component's
name. What is a body and what an element in the coupling is another matter: see
`cosim.structure.roles`.
"""

from enum import StrEnum
from typing import NamedTuple

HALVES = ("pinion_left", "pinion_right", "wheel_left", "wheel_right")
"""The four gear half-bodies and their bearing seats, in the thesis' order 1 ... 4. Left is +z."""
GEARS = ("pinion", "wheel")
SIDES = ("left", "right")
"""The two meshes of a double-helical pair."""


class Role(StrEnum):
    """What a part is in a gearbox or on its rig."""

    GEAR_PAIR = "gear pair"
    BEARING = "bearing"
    HOUSING = "housing"
    DRIVE = "drive"
    LOAD = "load"
    COUPLING = "shaft coupling"
    CONTROLLER = "controller"
    SENSOR = "sensor"
    ROTOR = "rotor"
    SOURCE = "torque source"
    SET_POINT = "set point"


class PortKind(StrEnum):
    """What two parts share where they are joined; both ends are of the same kind.

    The variables of a port are `port.variable`, by the rules of the physical interfaces: forces
    and motions `f_x`, `s_x`, `v_x` along the axes, or `tau`, `phi`, `w` about the own axis.
    """

    JOURNAL = "journal"
    """A gear half-body in its bearing, in the gear's frame."""
    SEAT = "seat"
    """A bearing in the housing, in the housing's frame."""
    FLANGE = "flange"
    """The end of a shaft."""


class Port(NamedTuple):
    """A port of a component.

    Attributes:
        name: its variables are `name.variable`.
        kind: what is joined there.
        place: where in the gearbox: one of HALVES, one of GEARS, or "".
    """

    name: str
    kind: PortKind
    place: str = ""


class Quantity(StrEnum):
    """What a variable, or a resource file, means to those who ask for a role."""

    SPEED = "speed"
    TORQUE = "torque"
    SPEED_SETPOINT = "speed set point"
    TORQUE_SETPOINT = "torque set point"
    CARRYING_FLANK = "carrying flank"
    NUMBER_OF_TEETH = "number of teeth"
    GEAR_RATIO = "gear ratio"
    BASE_RADIUS = "base radius"
    WORKING_PRESSURE_ANGLE = "working pressure angle"
    STIFFNESS_TABLE = "stiffness table"
    TOOTH_ERRORS = "tooth errors"
    TOOTH_DEVIATIONS = "tooth deviations"
    PAIR_LAW = "force law of a pair of teeth"
    MESH_FORCE = "mesh force"
    IMPACT_FORCE = "impact force"
    MESH_DEFLECTION = "mesh deflection"
    ELECTRICAL_POWER = "electrical power"
    RECOVERED_POWER = "recovered power"
    LOSS_POWER = "loss power"
    STIFFNESS = "stiffness"
    DAMPING = "damping"
    INERTIA = "inertia"
    MICRO_STEP = "micro step"
    LOAD_RAMP_TIME = "load ramp time"
    RISING_VALUE = "rising value"
    FINAL_VALUE = "final value"
    CLEARANCE = "clearance"
    SEAT_MOTION = "seat motion"
    MODES = "modes"
    SHAPES = "shapes"
