"""What scenes ask, with all outputs by name."""

from collections.abc import Sequence

from herringbone.analysis.leaner.asked_for import asked_for
from herringbone.analysis.leaner.question import Question
from herringbone.analysis.twin.fused.core import Core
from herringbone.scenes import Ask

USUAL = tuple(Ask((what,)) for what in ("bearing force", "seat velocity"))
"""What is looked at if a scene asks nothing."""


def questions_of(core: Core, asks: Sequence[Ask]) -> list[Question]:
    """What is asked, with all outputs by name.

    Raises:
        ParameterError: the system has no such output.
    """
    found: dict[str, Question] = {}
    for ask in asks:
        columns = dict.fromkeys(c for what in ask.what for c in asked_for(core, what))
        own = Question(ask.name, tuple(columns), ask.form, ask.tolerance, ask.band, ask.orders)
        known = found.get(ask.name)
        if known is None or own.tolerance < known.tolerance:
            found[ask.name] = own
    return list(found.values())
