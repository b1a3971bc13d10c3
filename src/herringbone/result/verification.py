"""How far a run is from one with other steps."""

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
    """

    groups: Mapping[str, float]
    worst: str
    worst_error: float
    step: float
    how: str

    @property
    def error(self) -> float:
        """Of the group that errs most; 0 if none varies."""
        return max(self.groups.values(), default=0.0)
