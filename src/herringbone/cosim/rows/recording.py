"""What a run leaves behind."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from herringbone.core import Outcome
from herringbone.core.energy_report import EnergyReport


class StepStatistics(NamedTuple):
    """Macro steps of an adaptive run.

    Attributes:
        accepted, rejected: how many.
        shortest, median, longest: of the accepted ones [s].
    """

    accepted: int
    rejected: int
    shortest: float
    median: float
    longest: float


class CoreStatistics(NamedTuple):
    """Steps of a system whose parts are fused into one core.

    Attributes:
        degree: of the polynomials of the laws.
        step: longest base step [s].
        steps: that were taken, of all lengths.
        halvings: of steps in which a law bends, or was not solved.
        evaluations: of all laws at all nodes of a step.
        bends: located places where a law bends, such as the end of contact.
    """

    degree: int
    step: float
    steps: int
    halvings: int
    evaluations: int
    bends: int


class ErrorEstimate(NamedTuple):
    """Error of a run that was asked for, and that its steps let expect.

    Attributes:
        asked: relative error that was asked for [1].
        coupling: of the polynomials and corrections between the parts [1].
        inner_steps: of the parts' own steps [1].
    """

    asked: float
    coupling: float
    inner_steps: float

    @property
    def error(self) -> float:
        """Both together [1]."""
        return math.hypot(self.coupling, self.inner_steps)


@dataclass(frozen=True)
class Recording:
    """What a run left behind.

    Attributes:
        time: recorded communication points (n,) [s].
        values: recorded outputs (n, m), columns as `names`.
        names: `instance.variable`.
        units: unit of each column, "" if not declared.
        outcome: how the run ended.
        step: communication step size [s], as used; of an adaptive run the mean.
        record_step: time between records [s], as used; of an adaptive run the mean.
        macro_steps: macro steps that were completed.
        passes: doStep calls by instance.
        rollbacks: state restores.
        wall_seconds: wall time of the loop, without compilation and the first Jacobian.
        cpu_seconds: CPU time of its thread since it began or went on; what child processes of
            foreign FMUs take is not in it.
        notes: downgrades and other lines that the user should read.
        steps: of an adaptive run, the lengths of its macro steps.
        energy: what the coupling added; None where no element has dampers.
        slow: bodies that step once in several macro steps, and in how many.
        others: recorded outputs of other types than real, (n,) of their own types by name.
        other_units: units of these, "" if not declared.
        estimate: of an adaptive run, its error.
        core: of a fused run, its steps.
    """

    time: np.ndarray
    values: np.ndarray
    names: tuple[str, ...]
    units: tuple[str, ...]
    outcome: Outcome
    step: float
    record_step: float
    macro_steps: int
    passes: dict[str, int]
    rollbacks: int
    wall_seconds: float
    cpu_seconds: float
    notes: tuple[str, ...]
    steps: StepStatistics | None = None
    energy: EnergyReport | None = None
    slow: Mapping[str, int] = field(default_factory=dict)
    others: Mapping[str, np.ndarray] = field(default_factory=dict)
    other_units: Mapping[str, str] = field(default_factory=dict)
    estimate: ErrorEstimate | None = None
    core: CoreStatistics | None = None
