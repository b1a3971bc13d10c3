"""Points of systems with foreign parts: what each settles to in a run."""

from dataclasses import dataclass, replace
from typing import Any

from herringbone.analysis.steady.solver import AS_IT_IS, TOLERANCE
from herringbone.core import OutcomeKind
from herringbone.running.loading import load_scene, system_and_folder
from herringbone.running.operating.commanded import commanded, with_known_values
from herringbone.running.operating.settled import LONGEST, settled
from herringbone.studies.evaluators.evaluator import Base, Evaluated, Evaluation
from herringbone.studies.evaluators.steady import STEADY, UNSETTLED, figures_of
from herringbone.studies.study import Point


@dataclass(frozen=True)
class Settled:
    """Runs that go on until levels do not change any more, see `running.operating.settled`.

    Attributes:
        tolerance: change of levels and means of all groups that counts as none.
        columns: further columns or patterns with figures of their own.
        duration: of a run at most [s].
        step: communication step size [s]; None: chosen.
        algorithm: coupling algorithm; None: chosen.
    """

    tolerance: float = TOLERANCE
    columns: tuple[str, ...] = ()
    duration: float = LONGEST
    step: float | None = None
    algorithm: str | None = None
    longest: int | None = 1
    modules: tuple[str, ...] = ("herringbone.studies.evaluators.settled",)
    has_series: bool = True

    def opened(self, base: Base) -> Evaluation:
        """Load system and scene; raises HerringboneError."""
        return _Settling(self, base)


class _Settling:
    """Runs of one system and scene."""

    def __init__(self, asked: Settled, base: Base) -> None:
        self._asked, self._wishes = asked, base.wishes
        self._system, folder = system_and_folder(base.system)
        self._scene = load_scene(folder, base.scene)
        self._known = with_known_values(self._system, self._scene, base.wishes)

    def __call__(self, point: Point, near: Any, *, series: bool) -> Evaluated:  # noqa: ANN401
        """See `Evaluation`."""
        del near
        asked = self._asked
        own = {name: value for name, value in point.items() if "." in name}
        values = commanded(self._known.with_values(own), point)
        wishes = replace(self._wishes, values={**self._wishes.values, **values})
        found = settled(
            self._system,
            self._scene,
            AS_IT_IS,
            wishes,
            asked.tolerance,
            asked.duration,
            asked.algorithm,
            asked.step,
        )
        outcome = found.run.outcome
        if outcome.kind is OutcomeKind.INTERRUPTED:
            raise KeyboardInterrupt
        kept = found.run if series else None
        if not outcome.reached_end or outcome.unstable:
            return Evaluated(outcome.kind.value, outcome.message, series=kept)
        told = "; ".join(found.unsettled)
        kind = STEADY if found.converged else UNSETTLED
        return Evaluated(kind, told, figures_of(found, asked.columns), series=kept)
