"""What a system has settled to in a run: the same figures as of a periodic steady state."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NoReturn

import numpy as np

from herringbone.analysis.figures.settling import (
    NOT_SETTLED,
    changes,
    moving_speed,
    settling_groups,
)
from herringbone.analysis.steady.of_runs.ending import Ending, ending_of
from herringbone.analysis.steady.outputs import Harmonics
from herringbone.analysis.steady.periodic import PeriodicMotion
from herringbone.core import ParameterError
from herringbone.core.declaring.units import R_MIN
from herringbone.core.places.part_path import PartPath
from herringbone.core.wording import percent
from herringbone.result.result import Result

UNTOLD = "multipliers, bends and sensitivities are not known: foreign parts show no equations"


@dataclass(frozen=True, repr=False, eq=False)
class SettledState(PeriodicMotion):
    """The motion in the last quarter of a run; see `PeriodicMotion`. Its time counts from there.

    Attributes:
        run: the run; its `budget` tells how far it may be from the gearbox that is meant.
        tolerance: change of levels and means from the third to the last quarter of the run, over
            the alternating part of each group of channels, that counts as none.
    """

    run: Result
    tolerance: float

    @property
    def system_name(self) -> str:
        """Of the system."""
        return self.run.info.system

    @property
    def parts(self) -> tuple[PartPath, ...]:
        """Of the system."""
        return self.run.parts

    @cached_property
    def changes(self) -> Mapping[str, float]:
        """By group of channels; empty if the run does not tell, as its speed is not steady."""
        return changes(self._even, smooth=True) or {}

    @property
    def converged(self) -> bool:
        """True if the run has settled, to figures that are known to the tolerance."""
        return bool(self.changes) and self.error <= self.tolerance

    @property
    def error(self) -> float:
        """The largest change, or doubt without a period; infinite if the run does not tell."""
        change = max(self.changes.values(), default=math.inf)
        return max([change, *self.ending.doubt.values()])

    @property
    def stable(self) -> bool:
        """True if it has settled: a run does not stay where small deviations grow."""
        return self.converged

    @property
    def multipliers(self) -> NoReturn:
        """Not known; raises ParameterError."""
        raise ParameterError(UNTOLD)

    @property
    def notes(self) -> tuple[str, ...]:
        """Lines that the user should read."""
        # the run's own line advises options that it has not been given by hand
        said = [line for line in self.run.info.notes if not line.startswith(NOT_SETTLED)]
        return (*said, *self.unsettled, *self.ending.notes, UNTOLD)

    @property
    def unsettled(self) -> list[str]:
        """Why it is not `converged`; empty if it is."""
        outcome = self.run.outcome
        if not outcome.completed:
            return [f"unsettled: the run is {outcome.kind.value}: {outcome.message}"]
        if not self.changes:
            moving = moving_speed(self._even) or "too little was recorded"
            return [f"unsettled after {outcome.time:g} s: {moving}"]
        group, change = max(self.changes.items(), key=lambda item: item[1])
        if change <= self.tolerance:
            return []  # what is in doubt then, its ending tells
        return [
            f"unsettled: {group.replace('_', ' ')} still changes by {percent(change)} of its "
            f"alternating part from the third to the last quarter of {outcome.time:g} s (asked "
            f"{100.0 * self.tolerance:g} %)"
        ]

    @cached_property
    def ending(self) -> Ending:
        """The last quarter, in harmonics."""
        return ending_of(self._even, self.tolerance)

    @property
    def period(self) -> float:
        """Time after which the motion repeats [s]."""
        return self.ending.period

    @property
    def meshes(self) -> int:
        """Mesh periods of the first gear pair in the period; 0: not known."""
        return self.ending.meshes

    @property
    def turns(self) -> float:
        """Turns of the first pinion in the period; NaN: not known."""
        return self.ending.turns

    @property
    def speed(self) -> float:
        """Mean speed of the first pinion [rad/s]; NaN: not known."""
        return self.ending.speed

    @property
    def numbers(self) -> np.ndarray:
        """(harmonics,) k up to half the sampling rate."""
        return np.arange(self.ending.coefficients.shape[1])

    @property
    def columns(self) -> tuple[str, ...]:
        """All outputs that are real numbers."""
        return tuple(self.run.signals)

    @cached_property
    def channels(self) -> Mapping[str, Sequence[str]]:
        """Columns by group of channels; of a system without, outputs by unit."""
        return {name.replace(" ", "_"): own for name, own in settling_groups(self._even).items()}

    def unit(self, column: str) -> str:
        """Of a column."""
        return self.run.units[column]

    def harmonics(self, columns: Sequence[str]) -> Harmonics:
        """Coefficients of columns."""
        place = {name: k for k, name in enumerate(self.columns)}
        own = [place[name] for name in columns]
        return Harmonics(self.ending.coefficients[own], self.numbers, self.ending.slopes[own])

    @cached_property
    def _even(self) -> Result:
        return self.run.uniform()

    def _facts(self) -> dict[str, str]:
        after = f"after {self.run.outcome.time:g} s"
        return {
            "system": self.system_name,
            "speed": f"{self.speed * R_MIN:.6g} r/min",
            "period": f"{self.period:.6g} s, {self.meshes} meshes",
            "outcome": "settled" if self.converged else "unsettled",
            "change": f"{self.error:.2g} (asked {self.tolerance:g}) {after}",
            **self.levels(),
        }
