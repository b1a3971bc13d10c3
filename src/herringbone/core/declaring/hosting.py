"""What hosts of native FMUs give and want, and what an FMU made for them asks of its wrapper."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np


class Given(StrEnum):
    """What the host gives at a flange."""

    TORQUE = "torque"
    MOTION = "motion"
    SPEED = "speed"


@dataclass(frozen=True)
class Wanted:
    """What a host wants to see.

    Attributes:
        given: what it gives, by flange; torque where nothing is said.
        outputs: patterns of further outputs, `instance.variable`.
        internals: all variables of the parts, as locals.
        nodes: the signals' nodes.
        parameters: all parameters.
        exchange: model exchange.
    """

    given: Mapping[str, Given] = field(default_factory=dict)
    outputs: tuple[str, ...] = ()
    internals: bool = False
    nodes: bool = False
    parameters: bool = False
    exchange: bool = False


class RunsOn(NamedTuple):
    """An input that is the integral of another one: where it is not set, it runs on.

    Attributes:
        input: name of the input, such as an angle.
        rate: name of the input that is its rate.
        since: name of the local that the wrapper sets to the time [s] at which the input was set,
            or to which it has run on.
    """

    input: str
    rate: str
    since: str


class Remark(NamedTuple):
    """What the wrapper logs once, as soon as it holds.

    Attributes:
        format: of the line; has %g conversions for the numbers of a report.
        warning: it is a warning; otherwise a matter of course.
    """

    format: str
    warning: bool = True


class Experiment(NamedTuple):
    """FMI's default experiment.

    Attributes:
        stop: end [s].
        step: communication step size [s].
        tolerance: relative, of inner steps; None: they have a fixed size.
    """

    stop: float
    step: float
    tolerance: float | None = None


HOLDS_NOW, FAILS_STEPS = 1, 2


@dataclass(frozen=True)
class ByTolerance:
    """How a native FMU's inner steps follow a tolerance, and what it says of them.

    Attributes:
        tolerance: name of the local that the wrapper sets to the host's tolerance.
        experiment: the default experiment.
        remarks: what may be told after a step, or at the end of initialisation.
        remark: kernel remark(b, w, which, report) -> int, on block and work space, with numbers in
            the report (`REPORT` of them): HOLDS_NOW where the remark holds, FAILS_STEPS where it is
            why a step failed that did, or both; else 0.
    """

    tolerance: str
    experiment: Experiment
    remarks: tuple[Remark, ...]
    remark: Callable[["np.ndarray", "np.ndarray", int, "np.ndarray"], int]


@dataclass(frozen=True)
class Asked:
    """How a native FMU makes its outputs when its host asks for them.

    Attributes:
        advance: kernel as `Kernels.step` that may leave states and outputs stale.
        answer: kernel answer(b, w, t, references, count) that writes those which are stale, at so
            many places in the block; all if no place is given.
        stale: place in the block that tells which are: 0 none, 1 those that were not asked for so
            far, 2 all.
    """

    advance: Callable[["np.ndarray", "np.ndarray", float, float], int]
    answer: Callable[["np.ndarray", "np.ndarray", float, "np.ndarray", int], None]
    stale: int


@dataclass(frozen=True)
class Hosting:
    """What a component asks of the wrapper, besides kernels and declaration.

    Attributes:
        settle: kernel settle(b, t) -> int that makes the states at the start time from parameters
            and inputs; 0: as it was asked for. Otherwise the wrapper logs a line of `not_settled`.
        not_settled: by status, from 1: what was looked for in vain, and what is done instead.
        runs_on: inputs that run on.
        exchange: model exchange is offered.
        notes: lines on what lies inside that its maker should read.
        models: by flange, the linear equations that this was found with, as JSON may hold them.
        advice: what is known of communication steps, as rows of a table; the first one is its head.
    """

    settle: Callable[["np.ndarray", float], int]
    not_settled: tuple[str, ...]
    runs_on: tuple[RunsOn, ...]
    exchange: bool
    notes: tuple[str, ...]
    models: Callable[[], dict[str, dict[str, list]]]
    advice: Callable[[], list[tuple[str, ...]]]
