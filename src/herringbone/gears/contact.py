"""What a mesh shows on the line of action: path of contact and tooth forces."""

from dataclasses import dataclass


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
