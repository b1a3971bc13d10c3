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

    Raises:
        ParameterError: a value is negative.
    """

    backlash: float | None = None
    damping_ratio: float = 0.1
    shaft_damping_ratio: float = 0.02
    bearing_damping_ratio: float = 0.02

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None and not value >= 0.0:
                raise ParameterError(f"[mesh] {name} = {value:g} must not be negative")
