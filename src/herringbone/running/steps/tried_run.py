"""A run of several with ever shorter steps, and what is known of its error."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from herringbone.analysis.accuracy.apart import Apart
from herringbone.analysis.accuracy.step_power import Left
from herringbone.running.coupled import Coupled


@dataclass(frozen=True)
class TriedRun:
    """A run that ended well, and what is known of its error.

    Attributes:
        found: the run.
        differences: from the run before; None for the first.
        groups: what each group errs: each falls with a power of its own, and the one that errs
            most now need not have done so with longer steps.
    """

    found: Coupled
    differences: Apart | None = None
    groups: Mapping[str, Left] = field(default_factory=dict)

    @property
    def step(self) -> float:
        """Macro step [s]."""
        return self.found.recording.step

    @property
    def apart(self) -> float:
        """Difference from the run before, of the group that differs most."""
        return max(self.differences.groups.values(), default=0.0) if self.differences else math.inf

    @property
    def worst(self) -> Left:
        """Of the group that errs most."""
        nothing = Left(0.0 if self.differences else math.inf, 1.0, 1.0)
        return max(self.groups.values(), key=lambda group: group.error, default=nothing)

    @property
    def error(self) -> float:
        """Of the group that errs most."""
        return self.worst.error

    @property
    def power(self) -> float:
        """With which that group's differences fall."""
        return self.worst.power
