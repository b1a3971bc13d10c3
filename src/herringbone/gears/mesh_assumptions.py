"""What geometry does not tell of a pair in its gearbox: backlash as mounted, and dampings."""

from dataclasses import dataclass

from herringbone.core import ParameterError


@dataclass(frozen=True)
class MeshAssumptions:
    """Section [mesh] of a gear file. The damping ratios are assumptions of this project.

    Attributes:
        backlash: normal [m]; None: by the tooth thickness.
        damping_ratio: zeta of the meshes.
        shaft_damping_ratio: of the halves of a gear against each other.
        bearing_damping_ratio: of a half on its bearings.
        impact_share: share of the largest meshing impact at the operating point that teeth have,
            0 to 1; 0.02 is that of the corner of a helical tooth, one of some fifty slices.

    Raises:
        ParameterError: a value is negative, or the share above 1.
    """

    backlash: float | None = None
    damping_ratio: float = 0.1
    shaft_damping_ratio: float = 0.02
    bearing_damping_ratio: float = 0.02
    impact_share: float = 0.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None and not value >= 0.0:
                raise ParameterError(f"[mesh] {name} = {value:g} must not be negative")
        if self.impact_share > 1.0:
            raise ParameterError(f"[mesh] impact_share = {self.impact_share:g} is more than 1")
