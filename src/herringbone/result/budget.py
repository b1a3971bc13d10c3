"""One row of the error budget of a run."""

from dataclasses import dataclass
from enum import StrEnum


class Known(StrEnum):
    """How a row is known."""

    MEASURED = "measured"
    ESTIMATED = "estimated"
    UNKNOWN = "unknown"


@dataclass(frozen=True)
class BudgetRow:
    """A source of error.

    Attributes:
        source: what errs.
        quantity: of which the value is the relative error.
        value: relative [1]; None if unknown.
        known: how it is known.
        how: where the value comes from, or why there is none.
    """

    source: str
    quantity: str
    value: float | None
    known: Known
    how: str
