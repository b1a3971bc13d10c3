"""A condensed system as it is marched to a periodic motion: nothing of it depends on the time."""

from dataclasses import dataclass

import numpy as np

from herringbone.analysis.twin.condensed.equations import settle_laws
from herringbone.analysis.twin.condensed.march_arrays import Calls
from herringbone.analysis.twin.condensed.system import Condensed


@dataclass(frozen=True)
class Held(Condensed):
    """A condensed system after all ramps, with constant signals (signals,).

    Attributes:
        constant: these signals.
        ramp: turns over which what comes in over an angle still does.
    """

    constant: np.ndarray
    ramp: float = 0.0

    def signals(self, t: float) -> np.ndarray:
        """Signals of the sources at a time [s]."""
        del t
        return self.constant

    @property
    def curved(self) -> bool:
        """True: constants are curves."""
        return True

    def calls(self) -> Calls:
        """Addresses, and fresh blocks."""
        found = super().calls()
        settle_laws(self.twin, found.blocks, self.ramp)
        return found
