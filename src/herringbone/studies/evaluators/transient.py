"""Points by runs: each a co-simulation, or a fused run where all equations are known."""

from dataclasses import dataclass
from typing import Any

from herringbone.analysis.figures.settling import unsettled
from herringbone.core import HerringboneError, OutcomeKind
from herringbone.running.api import run
from herringbone.running.loading import load_scene, system_and_folder
from herringbone.running.operating.commanded import commanded, with_known_values
from herringbone.studies.evaluators.evaluator import Base, Evaluated, Evaluation
from herringbone.studies.evaluators.levels import levels_over_time
from herringbone.studies.study import Point


@dataclass(frozen=True)
class Transient:
    """Runs.

    Attributes:
        fuse: condense all parts into one core; None: where all are components of this package.
        step: communication step size [s], of a fused run the base step; None: chosen.
        tolerance: relative error; None: as of `herringbone.run`, 1e-3 of own parts with a gear pair
            where neither step nor algorithm is given.
        algorithm: coupling algorithm; None: chosen.
        columns: further columns or patterns with figures of their own.
    """

    fuse: bool | None = None
    step: float | None = None
    tolerance: float | None = None
    algorithm: str | None = None
    columns: tuple[str, ...] = ()
    longest: int | None = 1
    modules: tuple[str, ...] = ("herringbone.studies.evaluators.transient",)
    has_series: bool = True

    def opened(self, base: Base) -> Evaluation:
        """Load system and scene; raises HerringboneError."""
        return _Runs(self, base)


class _Runs:
    """Runs of one system and scene."""

    def __init__(self, asked: Transient, base: Base) -> None:
        self._asked, self._wishes = asked, base.wishes
        system, folder = system_and_folder(base.system)
        scene = load_scene(folder, base.scene)
        self._system, self._scene = system, scene
        self._known = with_known_values(system, scene, base.wishes)
        self._fuse = asked.fuse
        if self._fuse is None:
            self._fuse = not (self._known.foreign_parts or asked.algorithm)

    def __call__(self, point: Point, near: Any, *, series: bool) -> Evaluated:  # noqa: ANN401
        """See `Evaluation`."""
        del near
        wishes, asked = self._wishes, self._asked
        values = commanded(self._known.with_values(_variables(point)), point)
        result = run(
            self._system,
            scene=self._scene,
            algorithm=asked.algorithm,
            step=asked.step,
            tolerance=asked.tolerance,
            t_end=wishes.t_end,
            record_step=wishes.record_step,
            start=wishes.start,
            replace_parts=wishes.replace_parts,
            values={**wishes.values, **values},
            gear=wishes.gear,
            housing=wishes.housing,
            fuse=bool(self._fuse),
        )
        outcome = result.outcome
        if outcome.kind is OutcomeKind.INTERRUPTED:
            raise KeyboardInterrupt
        kept = result if series else None
        if not outcome.reached_end or outcome.unstable:
            return Evaluated(outcome.kind.value, outcome.message, series=kept)
        try:
            figures = levels_over_time(result, asked.columns)
        except HerringboneError as error:
            return Evaluated(outcome.kind.value, str(error), series=kept)
        message = outcome.message or "; ".join(unsettled(result.uniform()))
        return Evaluated(outcome.kind.value, message, figures, series=kept)


def _variables(point: Point) -> Point:
    """Values of a point that name a variable."""
    return {name: value for name, value in point.items() if "." in name}
