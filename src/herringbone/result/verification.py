"""How far a run is from one with other steps."""

import math
from collections.abc import Mapping
from typing import NamedTuple


class Verification(NamedTuple):
    """Error of a run, by others with longer or shorter steps.

    Attributes:
        groups: error by group of channels, over the alternating part; by unit where a part has
            none. Groups that do not vary are left out.
        worst: the output with the largest error over its own alternating part; "" if none varies.
        worst_error: of that one.
        step: of the other run [s].
        how: what was compared, in words.
        asked: tolerance that the user asked for, and for which the step was searched; None: none.
        known: False if no other run ended well, so that nothing tells the error.
    """

    groups: Mapping[str, float]
    worst: str
    worst_error: float
    step: float
    how: str
    asked: float | None = None
    known: bool = True

    @property
    def error(self) -> float:
        """Of the group that errs most; 0 if none varies, NaN if it is not known."""
        return max(self.groups.values(), default=0.0 if self.known else math.nan)

    @property
    def missed(self) -> bool:
        """True if the error is above the tolerance that was asked for, or nobody knows it."""
        return self.asked is not None and not self.error <= self.asked
