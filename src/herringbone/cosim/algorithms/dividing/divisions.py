"""What is known of the macro steps of a run that were divided; see `dividing.divided`."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from herringbone.cosim.checkpoint.run_state import Arrays

_SAVED = "divisions"


@dataclass
class Divisions:
    """What was divided.

    Attributes:
        steps, pieces: macro steps so far, and what they were taken in.
        left: steps that jump and were not divided, as too many did or a part refuses short ones.
        since: time of the first of these [s].
    """

    steps: int = 0
    pieces: int = 0
    left: int = 0
    since: float = 0.0

    def notes(self) -> tuple[str, ...]:
        """Lines for the user."""
        found = []
        if self.steps:
            found.append(
                f"outputs of foreign parts jump or bend in {self.steps} macro steps, which were "
                f"taken in {self.pieces} pieces"
            )
        if self.left:
            found.append(
                f"{self.left} more such steps, from {self.since:g} s on, were taken whole, as "
                "most steps have a jump or a part takes no shorter ones: the coupling is of first "
                "order there"
            )
        return tuple(found)

    def saved(self) -> Arrays:
        """What is needed to go on, by name."""
        return {_SAVED: np.array([self.steps, self.pieces, self.left, self.since])}

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """Go on from there."""
        self.steps, self.pieces, self.left = map(int, saved[_SAVED][:3])
        self.since = float(saved[_SAVED][3])
