"""How a run ended: failures inside a run are outcomes with culprit and remedy, not exceptions."""

from dataclasses import dataclass
from enum import StrEnum


class OutcomeKind(StrEnum):
    """The ways in which a run ends."""

    COMPLETED = "completed"
    PART_LOST_AT_END = "completed_part_lost"
    PART_MAKES_ENERGY = "completed_part_makes_energy"
    WITH_NAN = "completed_with_nan"
    ENDED = "ended_by_part"
    INTERRUPTED = "interrupted"
    UNSTABLE = "unstable"
    DIVERGED = "diverged"
    PART_FAILED = "part_failed"
    COUPLING_FAILED = "coupling_failed"
    STEP_LIMIT = "step_limit"


EXIT_CODES = {
    OutcomeKind.COMPLETED: 0,
    OutcomeKind.ENDED: 0,
    OutcomeKind.PART_LOST_AT_END: 1,
    OutcomeKind.PART_MAKES_ENERGY: 1,
    OutcomeKind.WITH_NAN: 1,
    OutcomeKind.UNSTABLE: 1,
    OutcomeKind.DIVERGED: 1,
    OutcomeKind.PART_FAILED: 1,
    OutcomeKind.COUPLING_FAILED: 1,
    OutcomeKind.STEP_LIMIT: 1,
    OutcomeKind.INTERRUPTED: 130,
}
"""Exit code of a command whose run ended in one of these ways."""
_REACHED_END = {
    OutcomeKind.COMPLETED,
    OutcomeKind.UNSTABLE,
    OutcomeKind.PART_LOST_AT_END,
    OutcomeKind.PART_MAKES_ENERGY,
    OutcomeKind.WITH_NAN,
}


@dataclass(frozen=True)
class Outcome:
    """How, when and why a run ended.

    Attributes:
        kind: the way in which the run ended.
        time: simulated time that was reached [s].
        culprit: `instance.variable` or instance that ended the run early, or whose coupling is
            unstable; empty if there is none.
        message: one line that says what happened and what to do next; empty if completed.
    """

    kind: OutcomeKind
    time: float
    culprit: str = ""
    message: str = ""

    @classmethod
    def interrupted(cls, reached: float) -> "Outcome":
        """Of a run that was stopped by its user, at a time [s]."""
        message = f"stopped at {reached:g} s; results so far are kept"
        return cls(OutcomeKind.INTERRUPTED, reached, message=message)

    @property
    def completed(self) -> bool:
        """True if the run reached its end, and its coupling was not seen to be unstable."""
        return self.kind is OutcomeKind.COMPLETED

    @property
    def ended_well(self) -> bool:
        """True if the run completed, or ended where a part wanted it to."""
        return self.completed or self.kind is OutcomeKind.ENDED

    @property
    def reached_end(self) -> bool:
        """True if the run reached its end, with whatever values."""
        return self.kind in _REACHED_END

    @property
    def failed(self) -> bool:
        """True if a fault ended the run before its end."""
        return EXIT_CODES[self.kind] == 1 and not self.reached_end

    @property
    def unstable(self) -> bool:
        """True if the values grew without bound, so that no figure of them means anything."""
        return self.kind in {OutcomeKind.UNSTABLE, OutcomeKind.DIVERGED}
