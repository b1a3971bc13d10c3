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
        unresolved: steps in which it was no jump, but a motion faster than these.
    """

    steps: int = 0
    pieces: int = 0
    left: int = 0
    since: float = 0.0
    unresolved: int = 0

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
        if self.unresolved:
            found.append(
                f"in {self.unresolved} macro steps outputs of foreign parts change faster than "
                "these resolve, or jump at more than two places: they were not divided"
            )
        return tuple(found)

    def saved(self) -> Arrays:
        """What is needed to go on, by name."""
        known = [self.steps, self.pieces, self.left, self.since, self.unresolved]
        return {_SAVED: np.array(known)}

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """Go on from there."""
        steps, pieces, left, since, unresolved = saved[_SAVED]
        self.steps, self.pieces, self.left = int(steps), int(pieces), int(left)
        self.since, self.unresolved = float(since), int(unresolved)
