"""Flank modifications: what is taken off the flanks, as a gap between them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.core import ParameterError


@dataclass(frozen=True)
class Modification:
    """Parabolic tip relief and helix crowning of a pair.

    The gap of a relief of amount C over the length h, a distance u behind its beginning, is
    C (u/h)^2, normal to the flank; that of crowning is C (2 x / b - 1)^2 over the face width.

    Attributes:
        tip_relief: amounts at the tips of pinion and wheel [m].
        relief_length: h, along the path of contact [m].
        helix_crowning: at both ends of the face [m], of both gears together.
    """

    tip_relief: Sequence[float] = (0.0, 0.0)
    relief_length: float = 3e-3
    helix_crowning: float = 0.0

    def __post_init__(self) -> None:
        relief = tuple(float(amount) for amount in np.atleast_1d(self.tip_relief))
        if len(relief) != 2 or min(relief) < 0.0:
            raise ParameterError(
                f"tip relief {self.tip_relief} m must be two amounts (pinion, wheel), not negative"
            )
        object.__setattr__(self, "tip_relief", relief)
        if not self.relief_length > 0.0:
            raise ParameterError(f"relief length {self.relief_length:g} m must be positive")
        if not self.helix_crowning >= 0.0:
            raise ParameterError(f"helix crowning {self.helix_crowning:g} m must not be negative")

    def gap(self, path: np.ndarray, face: np.ndarray, length: float, width: float) -> np.ndarray:
        """Gap [m] normal to the flanks.

        Args:
            path: position on the path of contact, 0 at its start (wheel's tip) [m].
            face: position along the face [m], broadcast against `path`.
            length: of the path of contact [m].
            width: of the face [m].
        """
        at_end = np.maximum(0.0, path - (length - self.relief_length)) / self.relief_length
        at_start = np.maximum(0.0, self.relief_length - path) / self.relief_length
        relief = self.tip_relief[0] * at_end**2 + self.tip_relief[1] * at_start**2
        return relief + self.helix_crowning * (2.0 * face / width - 1.0) ** 2
