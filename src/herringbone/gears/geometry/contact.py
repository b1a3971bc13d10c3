"""What a mesh shows on the line of action: path of contact and tooth forces."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from herringbone.gears.geometry.gear_pair import GearPair


@dataclass(frozen=True)
class ToothForces:
    """Forces in the mesh [N] at a torque of the pinion; of one half where it says so.

    Attributes:
        tangential: at the reference circle, all halves together (F_t of ISO 6336).
        line_of_action: in the transverse plane, all halves together.
        normal: normal to the flank, one half.
        axial: one half.
        radial: toward the gear's axis, one half.
    """

    tangential: float
    line_of_action: float
    normal: float
    axial: float
    radial: float


@dataclass(frozen=True)
class PathOfContact:
    """Points of the path of contact: distances [m] from the pinion's base tangent point.

    Attributes:
        start: A, where the wheel's tip enters contact (the pinion drives).
        inner: B, lowest point of single tooth contact of the pinion (end minus one base pitch).
        pitch: C, the pitch point.
        outer: D, highest point of single tooth contact (start plus one base pitch).
        end: E, the pinion's tip.
        tangent_length: distance of both base tangent points.
    """

    start: float
    inner: float
    pitch: float
    outer: float
    end: float
    tangent_length: float

    @property
    def length(self) -> float:
        """Length of the path of contact g_alpha [m]."""
        return self.end - self.start


def path_of_contact(pair: "GearPair") -> PathOfContact:
    """Points A to E of a pair."""
    total = pair.center_distance * math.sin(pair.working_transverse_pressure_angle)
    reach = [
        math.sqrt(tip**2 - base**2)
        for tip, base in zip(pair.tip_radius, pair.base_radius, strict=True)
    ]
    start, end = total - reach[1], reach[0]
    return PathOfContact(
        start=start,
        inner=end - pair.transverse_base_pitch,
        pitch=pair.base_radius[0] * math.tan(pair.working_transverse_pressure_angle),
        outer=start + pair.transverse_base_pitch,
        end=end,
        tangent_length=total,
    )


def tooth_forces(pair: "GearPair", torque: float) -> ToothForces:
    """Static forces at a torque of the pinion [N m], shared equally by the halves.

    The normal force is T1 / (halves r_b1 cos(beta_b)): combined with base radii, the helix angle is
    the one at the base cylinder.
    """
    along = torque / pair.base_radius[0]
    half = along / pair.halves
    return ToothForces(
        tangential=torque / pair.reference_radius[0],
        line_of_action=along,
        normal=half / math.cos(pair.base_helix_angle),
        axial=half * math.tan(abs(pair.base_helix_angle)),
        radial=half * math.sin(pair.working_transverse_pressure_angle),
    )
