"""What every evaluator of points is, and what it finds."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np

from herringbone.cosim.structure.system import System
from herringbone.result.result import Result
from herringbone.running.prepared import Wishes
from herringbone.scenes import Scene
from herringbone.studies.study import Point


@dataclass(frozen=True)
class Base:
    """What all points of a study have in common.

    Attributes:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        scene: name or file of a scene, or one; None: the system's "loaded".
        wishes: over these.
        folder: in which relative names of files are looked up.
    """

    system: str | System
    scene: str | Scene | None = None
    wishes: Wishes = field(default_factory=Wishes)
    folder: str = "."


class Figure(NamedTuple):
    """A number in a row, and its unit."""

    value: float
    unit: str


@dataclass(frozen=True)
class Evaluated:
    """What was found at a point.

    Attributes:
        outcome: how it ended, as `core.OutcomeKind` says, or "failed": it could not begin.
        message: what there is to say about it.
        figures: by column.
        state: from which a neighbour starts; None: none can.
        series: rows over time, if they were asked for.
    """

    outcome: str
    message: str = ""
    figures: Mapping[str, Figure] = field(default_factory=dict)
    state: Any = None
    series: Result | None = None


class Evaluation(Protocol):
    """An evaluator made ready for a study, once in a process."""

    def __call__(self, point: Point, near: Any, *, series: bool) -> Evaluated:  # noqa: ANN401
        """Evaluate a point.

        Args:
            point: of the study.
            near: state of the neighbour before it; None: there is none.
            series: hand on rows over time.

        Raises:
            HerringboneError: it cannot be evaluated, which is a failed point.
        """


@runtime_checkable
class Resumable(Protocol):
    """An evaluation whose neighbours can be kept in a file, and give the same bits from there."""

    def kept(self, near: Any) -> Mapping[str, np.ndarray]:  # noqa: ANN401
        """Arrays, no objects, from which a neighbour is made again."""
        raise NotImplementedError

    def renewed(self, kept: Mapping[str, np.ndarray]) -> Any:  # noqa: ANN401
        """The neighbour; raises HerringboneError, KeyError or ValueError."""
        raise NotImplementedError


class Evaluator(Protocol):
    """What computes the points of a study. It is pickled, and tells by its text what it asks for.

    Attributes:
        longest: points that make a chain at most, each of which starts from the one before; None:
            all that are neighbours.
        modules: that compute; with all that they import they are part of a point's address.
        has_series: it finds rows over time.
        columns: outputs (`*`, `?`), or groups of channels, that have figures of their own.
    """

    @property
    def longest(self) -> int | None:
        """See above."""

    @property
    def modules(self) -> tuple[str, ...]:
        """See above."""
        raise NotImplementedError

    @property
    def has_series(self) -> bool:
        """See above."""
        raise NotImplementedError

    @property
    def columns(self) -> tuple[str, ...]:
        """See above."""
        raise NotImplementedError

    def opened(self, base: Base) -> Evaluation:
        """Make it ready; raises HerringboneError."""
