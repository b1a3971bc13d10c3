"""How far a run is from one with half the step."""

from collections.abc import Mapping
from typing import NamedTuple


class Verification(NamedTuple):
    """Error of a run, by one with half the step.

    Attributes:
        groups: error by group of channels, over the alternating part; of all outputs if there are
            no groups.
        worst: the output with the largest error over its own alternating part; "" if none varies.
        worst_error: of that one.
        step: of the second run [s].
    """

    groups: Mapping[str, float]
    worst: str
    worst_error: float
    step: float
