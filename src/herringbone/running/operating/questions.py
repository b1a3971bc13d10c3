"""What scenes ask, with all outputs by name."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from herringbone.analysis.leaner.asked_for import POWER, SENSOR, asked_for
from herringbone.analysis.leaner.form import Form
from herringbone.analysis.leaner.question import Question, lines_of
from herringbone.analysis.leaner.views import View, power_view, sensors_view
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.twin.fused.core import Core
from herringbone.core import ParameterError
from herringbone.scenes import Ask

USUAL = tuple(Ask((what,)) for what in ("bearing force", "seat velocity"))
"""What is looked at if a scene asks nothing."""
_SENSOR = re.compile(rf"{SENSOR}s?(?:[\s_]+(.+))?", re.IGNORECASE)


def questions_of(core: Core, asks: Sequence[Ask]) -> list[Question]:
    """What is asked, with all outputs by name.

    Raises:
        ParameterError: the system has no such output.
    """
    found: dict[str, Question] = {}
    for ask in (own for each in asks for own in _by_kind(each)):
        view, columns = _columns(core, ask)
        own = Question(ask.name, columns, ask.form, ask.tolerance, ask.band, ask.orders, view)
        known = found.get(ask.name)
        if known is None or own.tolerance < known.tolerance:
            found[ask.name] = own
    return list(found.values())


def answers(state: SteadyState, asks: Sequence[Ask]) -> Iterator[str]:
    """Levels of sensors and sound that are asked for: no outputs of a steady state."""
    for question in questions_of(state.structure.core, asks):
        if question.view is not None:
            own = lines_of(state, question)
            yield f"{question.name}: {question.view.told(own.coefficients)}"


def _by_kind(ask: Ask) -> Iterator[Ask]:
    """An ask as one of outputs, one of sensors and one of sound, which have no size in common."""
    kinds: dict[str, list[str]] = {}
    for what in ask.what:
        word = what.replace("_", " ").strip().lower()
        kind = word if _sensor(what) is None else SENSOR
        kinds.setdefault(kind if kind in {SENSOR, POWER} else "", []).append(what)
    yield from (replace(ask, what=tuple(own)) for own in kinds.values())


def _sensor(what: str) -> str | None:
    """Name of a sensor that is asked for; "" for all of them, None for something else."""
    found = _SENSOR.fullmatch(what.strip())
    return None if found is None else (found[1] or "")


def _columns(core: Core, ask: Ask) -> tuple[View | None, tuple[str, ...]]:
    """What is asked for as a view on outputs, and these."""
    system = core.twin.system
    named = [name for what in ask.what if (name := _sensor(what)) is not None]
    if named:
        names = dict.fromkeys(named) if all(named) else system.sensors
        view, columns = sensors_view(system, tuple(names))
        return view, tuple(columns)
    if ask.what[0].replace("_", " ").strip().lower() == POWER:
        if ask.form is Form.SIGNAL:
            raise ParameterError(f"ask: {POWER} is a mean over time; ask for it as level or lines")
        power, columns = power_view(system)
        return power, tuple(columns)
    return None, tuple(dict.fromkeys(c for what in ask.what for c in asked_for(core, what)))
