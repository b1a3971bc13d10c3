"""A leaner model that a scene has: where it is refused, and what is said of its error."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from herringbone.analysis.accuracy.error_budget import by_size
from herringbone.core import ParameterError
from herringbone.core.declaring.units import R_MIN
from herringbone.core.wording import option, percent
from herringbone.result.budget import BudgetRow, Known
from herringbone.result.result import Result
from herringbone.scenes import Model, Scene
from herringbone.scenes.asking import Range

if TYPE_CHECKING:
    from herringbone.running.prepared import Wishes

SOURCE = "model left out"
"""Row of the error budget that tells a model's error."""
_ROUNDING = 1e-9
"""Of an end of a range, which was in other units."""
Own = tuple[float | None, float | None]
"""Speed [rad/s] and torque [N m] that a system has."""


def refuse_lean(scene: Scene) -> None:
    """Refuse a leaner model where the whole one would be taken; raises ParameterError."""
    if scene.model:
        raise ParameterError(
            f"scene {scene.name}: [model]: leaner models are of steady states, sweeps of them, and "
            "runs with fuse, without foreign parts, and of an FMU by export, "
            f"{option('as_fmu', True)}; drop [model] for the whole one"
        )


def refuse_frozen(scene: Scene) -> None:
    """Refuse frozen laws in a run; raises ParameterError."""
    if scene.model.straight:
        raise ParameterError(
            f"scene {scene.name}: [model]: laws are frozen in steady states, which tell the model "
            "error, and in sweeps of them; drop frozen and linear for a run"
        )


def lean_notes(
    model: Model,
    changed: Mapping[str, object],
    speed: float | None = None,
    torque: float | None = None,
    own: Own = (None, None),
    elsewhere: str = "at this operating point",
) -> tuple[str, ...]:
    """What a user should know of the error of a leaner model; nothing of a whole one.

    Args:
        model: of the scene.
        changed: what the caller set besides, see `changed_by`.
        speed, torque: operating point that the caller asked for [rad/s, N m].
        own: the same of the system, where the caller asked for none; None: not known.
        elsewhere: where it is not known, if it is not there.
    """
    if not model:
        return ()
    parts = [f"{len(model.hold)} states held"] if model.hold else []
    parts += [f"{', '.join(model.one_way)} driven one way"] if model.one_way else []
    parts += [f"laws of {', '.join(own)} frozen" for own in (model.frozen, model.linear) if own]
    parts += [f"{count} harmonics of the tables of {part}" for part, count in model.harmonics]
    said = f"leaner model: {', '.join(parts)}; its error "
    if model.error is None:
        return (f"{said}is not certified: 'herringbone plan' does that",)
    where = f"at most {percent(model.error)} of what the scene asks{_where(model)}"
    if changed:
        names = ", ".join(sorted(changed))
        return (f"{said}was {where}, but is not known with other values of {names}",)
    if not certified(model, changed, speed, torque, own):
        return (f"{said}is {where}, but not known {elsewhere}",)
    return (f"{said}is {where}",)


def changed_by(wishes: "Wishes") -> dict[str, object]:
    """What a caller set besides a scene, by name: values, gears, housings, replaced parts."""
    given = {"gear": wishes.gear, "housing": wishes.housing}
    named = {name: value for name, value in given.items() if value}
    return {**wishes.values, **named, **wishes.replace_parts}


def certified(
    model: Model,
    changed: Mapping[str, object],
    speed: float | None = None,
    torque: float | None = None,
    own: Own = (None, None),
) -> bool:
    """True if the error of a leaner model is known; see `lean_notes`."""
    known = model.error is not None and not changed
    at = _within(speed, own[0], model.speed), _within(torque, own[1], model.torque)
    return known and all(at)


def certified_row(model: Model) -> BudgetRow | None:
    """What a plan certified of a leaner model, for the error budget; None of a whole one."""
    if not model:
        return None
    how = f"the largest of all questions, steady states{_where(model)}"
    return BudgetRow(SOURCE, "what the scene asks", model.error, Known.MEASURED, how)


def with_row(result: Result, row: BudgetRow | None) -> Result:
    """The result of a run, with a row besides in its error budget, if it has one."""
    if row is None or not result.budget:
        return result
    return replace(result, budget=by_size([*result.budget, row]))


def _within(asked: float | None, own: float | None, ends: Range | None) -> bool:
    """True if what is asked for, or is there, is where a model was certified."""
    if ends is None:
        return asked is None
    value = own if asked is None else asked
    slight = _ROUNDING * max(map(abs, ends))
    return value is not None and ends[0] - slight <= value <= ends[1] + slight


def _where(model: Model) -> str:
    found = []
    if model.speed:
        low, high = (R_MIN * speed for speed in model.speed)
        found.append(f"{low:.5g} to {high:.5g} r/min")
    if model.torque:
        found.append(f"{model.torque[0]:.5g} to {model.torque[1]:.5g} N m")
    return f", certified for {', '.join(found)}" if found else ", certified where the scene is"
