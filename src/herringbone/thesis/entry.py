"""What an entry of the report is: a study of the thesis, its sentences, and our verdicts."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

import pandas as pd

if TYPE_CHECKING:
    from matplotlib.figure import Figure

UNITS = "units"
"""Attribute of a table that holds its units by column; texts and pure numbers have none."""


class Verdict(Enum):
    """What our model says about a sentence of the thesis."""

    AGREES = "agrees"
    CONTRADICTS = "contradicts"
    NEEDS_AN_ASSUMPTION = "needs an assumption"
    CANNOT_BE_TESTED = "cannot be tested"

    @classmethod
    def of(cls, holds: object, *, assuming: bool = False) -> "Verdict":
        """Of a sentence that holds, or not; `assuming`: what the thesis does not say."""
        if not holds:
            return cls.CONTRADICTS
        return cls.NEEDS_AN_ASSUMPTION if assuming else cls.AGREES

    @classmethod
    def needing(cls, shipped: object, otherwise: object) -> "Verdict":
        """Of a sentence that holds with shipped values, or else with others."""
        return cls.AGREES if shipped else cls.of(otherwise, assuming=True)


@dataclass(frozen=True)
class Finding:
    """A sentence of the thesis, and what we find.

    Attributes:
        sentence: what the thesis says, in our words, short.
        verdict: on it.
        number: that the verdict rests on; None if there is none.
        unit: of the number, as people write it; "" for pure numbers.
        what: what the number is, after it: "248.24 Hz `against 248.24 Hz`".
        why: the assumption that is needed, why it cannot be tested, or what decides.
        margin: difference of the number between machines that is no other result, in its unit;
            besides it a thousandth of the number.
    """

    sentence: str
    verdict: Verdict
    number: float | None
    unit: str
    what: str
    why: str = ""
    margin: float = 0.0

    def __post_init__(self) -> None:
        """Numbers of numpy become those of Python, which a file can hold."""
        if self.number is not None:
            object.__setattr__(self, "number", float(self.number))


@dataclass(frozen=True)
class Outcome:
    """What an entry has computed.

    Attributes:
        tables: tidy tables by name; columns hold numbers or texts, `attrs["units"]` their units.
        findings: computed from the tables.
    """

    tables: Mapping[str, pd.DataFrame]
    findings: tuple[Finding, ...]


Tables = Mapping[str, pd.DataFrame]


@dataclass(frozen=True)
class Entry:
    """A study of the thesis.

    Attributes:
        name: what `herringbone study thesis NAME` takes.
        group: key of `registry.GROUPS`.
        title: for people.
        source: where the thesis has it: "chapter 2.3, figures 2.1 and 2.2".
        shows: what the thesis shows and says, in our words.
        compute: a function of a module, that gives the same bits whenever it is called.
        draw: pictures by name from the tables alone; it imports `plotting` when it is called.
        seconds: that it takes on one core, about; long ones begin first.
    """

    name: str
    group: str
    title: str
    source: str
    shows: str
    compute: Callable[[], Outcome]
    draw: Callable[[Tables], Mapping[str, "Figure"]]
    seconds: float = 5.0

    @property
    def command(self) -> str:
        """The command that makes it."""
        return f"herringbone study thesis {self.name}"


def table(columns: Mapping[str, object], units: Mapping[str, str] | None = None) -> pd.DataFrame:
    """A table of an outcome.

    Args:
        columns: values by name.
        units: by column; none of texts and pure numbers.
    """
    found = pd.DataFrame(dict(columns))
    found.attrs[UNITS] = dict(units or {})
    return found
