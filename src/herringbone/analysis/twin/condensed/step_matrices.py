"""Matrices of the steps of one march: shared with other marches, exact about its own reference."""

import numpy as np

from herringbone.analysis.twin.condensed.rungs import Rungs, Shape, make_rung, refer
from herringbone.analysis.twin.condensed.system import Condensed

HALVINGS = 7
"""Rungs below the base step."""


class StepMatrices:
    """Matrices by the length of the base step; each rung is made when it is first used.

    Args:
        system: whose.
        shape: of the steps.
        reference: (channels,) about which they are exact; see `refer`.
    """

    def __init__(self, system: Condensed, shape: Shape, reference: np.ndarray) -> None:
        self._system, self._shape, self._reference = system, shape, reference
        self._own: dict[float, Rungs] = {}
        self._shared: dict[float, Rungs] = {}

    def of(self, h: float) -> Rungs:
        """Matrices of steps of a length [s], and of shorter ones; see `make`."""
        if h not in self._own:
            lengths = [h / 2**k for k in range(HALVINGS + 1)]
            self._shared[h] = shared = self._system.rungs(lengths, self._shape)
            made, still = np.zeros_like(shared.made), np.zeros_like(shared.still)
            self._own[h] = shared._replace(made=made, still=still)
        return self._own[h]

    def make(self, rungs: Rungs, rung: int) -> None:
        """Fill in the matrices of a rung."""
        if not rungs.made[rung]:
            shared = self._shared[float(rungs.lengths[0])]
            if not shared.made[rung]:
                make_rung(shared, rung, self._system.modes, self._shape)
            refer(rungs, rung, self._reference)
            rungs.made[rung] = 1

    def renew(self) -> None:
        """Let all that are made be exact about the reference as it is now."""
        for rungs in self._own.values():
            for rung in np.flatnonzero(rungs.made):
                refer(rungs, int(rung), self._reference)
