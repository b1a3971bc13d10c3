"""What is known of a leaner model's error at the points of a study."""

from collections.abc import Mapping

from herringbone.analysis.set_points import SPEED, TORQUE
from herringbone.running.operating.lean import Own, lean_notes
from herringbone.scenes import Model
from herringbone.scenes.asking import Range
from herringbone.studies.study import SET_POINTS, Study


def leaner_notes(
    model: Model, study: Study, given: Mapping[str, object], own: Own
) -> tuple[str, ...]:
    """Lines as of one state, see `lean_notes`; nothing of a whole model.

    Args:
        model: of the scene.
        study: its points.
        given: what all points have besides, see `changed_by`.
        own: speed and torque where the study varies none.
    """
    if not model:
        return ()
    varied = dict.fromkeys(name for name in study.names if name not in SET_POINTS)
    speed = _farthest(study, SPEED, model.speed)
    torque = _farthest(study, TORQUE, model.torque)
    elsewhere = "at other points of the study"
    return lean_notes(model, {**given, **varied}, speed, torque, own, elsewhere)


def _farthest(study: Study, name: str, ends: Range | None) -> float | None:
    """The value that lies farthest outside of what was certified; None: the scene's holds."""
    if name not in study.names:
        return None
    low, high = ends or (0.0, 0.0)
    values = [float(study.point(number)[name]) for number in range(len(study.points))]
    return max(values, key=lambda value: max(low - value, value - high))
