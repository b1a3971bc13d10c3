"""What components take from a gear pair: the values that follow from its file."""

import math
from dataclasses import dataclass

Both = tuple[float, float]
"""Values of pinion and wheel."""


@dataclass(frozen=True)
class PairValues:
    """Values of a double-helical pair, SI units; of both gears where there are two.

    A component that belongs to a pair makes its parameters of them (`Component.of_pair`).

    Attributes:
        number_of_teeth: of the gears.
        base_radius: [m].
        half_mass: of one half of each gear [kg].
        half_inertia: of one half, about its axis [kg m2].
        shaft_radial, shaft_axial: stiffness of the gap shafts [N/m].
        shaft_torsional: the same [N m/rad].
        base_helix_angle: beta_b, positive [rad].
        working_pressure_angle: alpha_wt, transverse [rad].
        face_width: of one half [m].
        backlash: normal [m].
        coast_phase: phase of the drive flank plus that of the coast flank, 0 to 1 [mesh periods].
        total_contact_ratio: epsilon_gamma, of one half.
        mesh_damping_ratio: zeta of the meshes.
        shaft_damping_ratio: of the halves of a gear against each other.
        bearing_damping_ratio: of a half on its bearings.
    """

    number_of_teeth: Both
    base_radius: Both
    half_mass: Both
    half_inertia: Both
    shaft_radial: Both
    shaft_axial: Both
    shaft_torsional: Both
    base_helix_angle: float
    working_pressure_angle: float
    face_width: float
    backlash: float
    coast_phase: float
    total_contact_ratio: float
    mesh_damping_ratio: float
    shaft_damping_ratio: float
    bearing_damping_ratio: float

    @property
    def gear_ratio(self) -> float:
        """Torque of the wheel per torque of the pinion."""
        return self.number_of_teeth[1] / self.number_of_teeth[0]

    @property
    def center_distance(self) -> float:
        """Working centre distance [m]."""
        return sum(self.base_radius) / math.cos(self.working_pressure_angle)

    def shaft_damping(self, gear: int) -> tuple[float, float, float]:
        """Gap shaft in bending [N s/m], tension [N s/m] and torsion [N m s/rad].

        By the damping ratio, of the two halves of the gear against each other.
        """
        mass, inertia = self.half_mass[gear], self.half_inertia[gear]
        pairs = (
            (self.shaft_radial[gear], mass),
            (self.shaft_axial[gear], mass),
            (self.shaft_torsional[gear], inertia),
        )
        radial, axial, torsional = (
            2.0 * self.shaft_damping_ratio * math.sqrt(k * m / 2.0) for k, m in pairs
        )
        return radial, axial, torsional

    def bearing_damping(self, gear: int, stiffness: float) -> float:
        """Damping [N s/m] of a half of the gear on a bearing stiffness [N/m]."""
        return 2.0 * self.bearing_damping_ratio * math.sqrt(stiffness * self.half_mass[gear])
