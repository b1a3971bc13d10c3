"""How far a run is from one with other steps."""

import math
from collections.abc import Mapping
from typing import NamedTuple

from herringbone.core import Outcome, OutcomeKind

HALVED = "the run with half the step"


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


def error_unknown(outcome: Outcome, run: str, error: str = "the error") -> str:
    """A line on an error that is not known, as a run did not end well.

    Args:
        outcome: of that run.
        run: which one it is.
        error: what is not known.
    """
    if outcome.kind is OutcomeKind.INTERRUPTED:
        return f"{error} is not known: {run} was stopped at {outcome.time:g} s"
    return f"{error} is not known: {run} did not end well: {outcome.message or outcome.kind.value}"
