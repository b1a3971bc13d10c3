"""What a mesh shows on the line of action: path of contact and tooth forces."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from herringbone.gears.geometry.gear_pair import GearPair


@dataclass(frozen=True)
class MeshForces:
    """Forces in the mesh [N]: of one half, or of a whole pair.

    The tangential and the radial force are the force on the line of action, resolved at the
    reference circle (pressure angle alpha_t, as ISO 6336 does) or at the working pitch circle
    (alpha_wt, where the bearings feel them).

    Attributes:
        tangential_reference: at the reference circle; F_t of ISO 6336.
        radial_reference: toward the gear's axis, at the reference circle.
        tangential_working: at the working pitch circle.
        radial_working: toward the gear's axis, at the working pitch circle.
        line_of_action: in the transverse plane.
        normal: normal to the flanks; of a pair the sum of both halves.
        axial: the halves of a double-helical pair cancel.
    """

    tangential_reference: float
    radial_reference: float
    tangential_working: float
    radial_working: float
    line_of_action: float
    normal: float
    axial: float


@dataclass(frozen=True)
class ToothForces:
    """Static forces in the mesh at a torque of the pinion.

    Attributes:
        pair: of all halves together.
        half: of one half.
    """

    pair: MeshForces
    half: MeshForces

    @property
    def normal(self) -> float:
        """Normal to the flank, one half [N]: the load of stiffness tables."""
        return self.half.normal


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
    axial = along * math.tan(abs(pair.base_helix_angle))
    half = _resolved(pair, along / pair.halves, axial / pair.halves)
    return ToothForces(_resolved(pair, along, 0.0 if pair.halves == 2 else axial), half)


def _resolved(pair: "GearPair", along: float, axial: float) -> MeshForces:
    """Forces of a force on the line of action [N]."""
    reference, working = pair.transverse_pressure_angle, pair.working_transverse_pressure_angle
    return MeshForces(
        tangential_reference=along * math.cos(reference),
        radial_reference=along * math.sin(reference),
        tangential_working=along * math.cos(working),
        radial_working=along * math.sin(working),
        line_of_action=along,
        normal=along / math.cos(pair.base_helix_angle),
        axial=axial,
    )
