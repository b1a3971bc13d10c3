"""What a test of a contract found."""

from dataclasses import dataclass
from enum import StrEnum


class Verdict(StrEnum):
    """What a test says of a contract."""

    HOLDS = "holds"
    FAILS = "FAILS"
    REMARK = "remark"
    """Legal, but worth knowing."""
    NOT_TESTED = "not tested"


@dataclass(frozen=True)
class Finding:
    """One test.

    Attributes:
        test: its name.
        verdict: what it says.
        measured: what was seen, with its unit; why nothing was tested.
        limit: what is allowed.
    """

    test: str
    verdict: Verdict
    measured: str
    limit: str = ""

    @property
    def holds(self) -> bool:
        """False if the contract is broken."""
        return self.verdict is not Verdict.FAILS


def judged(test: str, holds: bool, measured: str, limit: str) -> Finding:
    """A finding that holds or fails."""
    return Finding(test, Verdict.HOLDS if holds else Verdict.FAILS, measured, limit)


def remark(test: str, measured: str, limit: str = "") -> Finding:
    """A finding that is legal, but worth knowing."""
    return Finding(test, Verdict.REMARK, measured, limit)


def not_tested(test: str, why: str) -> Finding:
    """A test that was not possible."""
    return Finding(test, Verdict.NOT_TESTED, why)
