"""A plan as text, as numbers of a JSON object, and as a scene that others can run."""

import json
import math
from collections.abc import Iterator, Sequence
from pathlib import Path

from herringbone.core import HerringboneError
from herringbone.core.declaring.units import R_MIN
from herringbone.core.errors import reason
from herringbone.core.places.files import write_whole
from herringbone.core.wording import percent
from herringbone.scenes import Motion
from herringbone.scenes.scene_text import scene_text
from herringbone.studies.planning.plan import Plan
from herringbone.studies.planning.rung import FUSED, Rung, Worst

SCENE, SUMMARY = "scene.toml", "plan.json"


def plan_text(plan: Plan) -> list[str]:
    """Lines for people."""
    lines = [f"Plan for {plan.system}, scene {plan.scene.name}"]
    lines += [
        f"  asked: {question.name}, {len(question.outputs)} outputs, to "
        f"{100.0 * question.tolerance:g} %"
        for question in plan.questions
    ]
    width = max(len(rung.name) for rung in plan.rungs)
    lines += ["", f"  {'':{width}}  {'estimate':>9}  {'measured':>9}  {'CPU/answer':>10}"]
    for rung in plan.rungs:
        chosen = "<- choice" if not rung.why else rung.why
        lines.append(
            f"  {rung.name:{width}}  {_percent(rung.estimate):>9}  {_percent(rung.measured):>9}  "
            f"{_time(rung.cost):>10}  {chosen}"
        )
    return [*lines, "", *_said(plan)]


def estimates_text(rungs: Sequence[Rung]) -> list[str]:
    """Lines for people, before any leaner model is solved."""
    width = max(len(rung.name) for rung in rungs)
    lines = [f"  {rung.name:{width}}  {_percent(rung.estimate):>9}" for rung in rungs]
    return ["Model errors, estimated before any leaner model is solved:", *lines, ""]


def _said(plan: Plan) -> Iterator[str]:
    choice = plan.choice
    yield f"Choice: {choice.name}, as {choice.solver}{_how(plan)}"
    if choice.measured is not None:
        at = choice.measured
        yield (
            f"  certified: {percent(at.error)} of the {at.question.name}{_where(at)}, worst "
            f"output {at.worst}: {percent(at.worst_error)}"
        )
        if at.largest > at.error:
            yield f"  certified of all questions: at most {percent(at.largest)}"
    if choice.lean:
        lean = choice.lean
        tables = (f"{part}: harmonics above {count}" for part, count in lean.harmonics)
        parts = (*lean.one_way, *lean.straight, *tables)
        yield f"  left out: {'; '.join((*_short(lean.hold), *parts))}"
    yield f"Planning took {plan.seconds:.2g} s of CPU time. {_worth(plan)}"
    yield from (f"note: {note}" for note in plan.notes)


def _how(plan: Plan) -> str:
    if plan.choice.step:
        return f", steps of {1e6 * plan.choice.step:.4g} us"
    return f", harmonics and iterations to {plan.tolerance:.2g}"


def _worth(plan: Plan) -> str:
    if plan.scene.operating.motion is Motion.TRANSIENT:
        return ""
    if not plan.saved:
        return (
            "Leaving things out saves nothing here: another plan is not worth its cost, solve the "
            f"whole model{_of_a_run(plan)}"
        )
    answers = math.ceil(plan.seconds / plan.saved)
    return (
        f"Leaving things out saves {_time(plan.saved)} an answer against steady states of the "
        f"whole model: for fewer than {answers} answers planning costs more than it saves"
        f"{_of_a_run(plan)}"
    )


def _of_a_run(plan: Plan) -> str:
    """That a run would cost less than the choice, if it does."""
    cost, runs = plan.choice.cost or 0.0, (r for r in plan.rungs if r.solver == FUSED)
    run = next(runs, None)
    if run is None or run.cost is None or run.cost >= cost:
        return ""
    return (
        f". A fused run costs less, {_time(run.cost)}, and answers as well if all has settled in "
        f"{plan.scene.t_end:g} s, which was not tried"
    )


def _short(held: tuple[str, ...]) -> Iterator[str]:
    """States that are held by part, without the rates of those that are there."""
    names, parts = set(held), dict[str, list[str]]()
    for name in held:
        if not _rate_of(name, names):
            words = name.split(".")
            first = next((k for k, w in enumerate(words) if "(" in w), len(words) - 1)
            parts.setdefault(".".join(words[:first]), []).append(".".join(words[first:]))
    yield from (f"{part}: {', '.join(own)}" for part, own in parts.items())


def _rate_of(name: str, names: set[str]) -> bool:
    return ".der(" in name and name.replace(".der(", ".").removesuffix(")") in names


def _percent(found: Worst | None) -> str:
    return "" if found is None else percent(found.error, 3)


def _time(seconds: float | None) -> str:
    return "" if seconds is None else f"{1e3 * seconds:.3g} ms"


def _where(found: Worst) -> str:
    speed, torque = found.point.speed, found.point.torque
    said = [f"{R_MIN * speed:.5g} r/min"] if speed is not None else []
    said += [f"{torque:.5g} N m"] if torque is not None else []
    return f" at {', '.join(said)}" if said else ""


def plan_summary(plan: Plan) -> dict:
    """Figures of a plan, for JSON; SI units."""
    return {
        "system": plan.system,
        "scene": plan.scene.name,
        "motion": plan.scene.operating.motion,
        "questions": [
            {"name": q.name, "columns": list(q.columns), "tolerance": q.tolerance}
            for q in plan.questions
        ],
        "rungs": [_rung(rung) for rung in plan.rungs],
        "choice": plan.choice.name,
        "solver": plan.choice.solver,
        "step": plan.choice.step or None,
        "tolerance": plan.tolerance,
        "planning": plan.seconds,
        "saved": plan.saved,
        "notes": list(plan.notes),
    }


def _rung(rung: Rung) -> dict:
    return {
        "name": rung.name,
        "held": list(rung.lean.hold),
        "one_way": list(rung.lean.one_way),
        "frozen": list(rung.lean.frozen),
        "linear": list(rung.lean.linear),
        "harmonics": dict(rung.lean.harmonics),
        "estimate": _figures(rung.estimate),
        "measured": _figures(rung.measured),
        "cost": rung.cost,
        "why_not": rung.why,
    }


def _figures(found: Worst | None) -> dict | None:
    if found is None:
        return None
    return {
        "error": found.error,
        "largest": found.largest,
        "question": found.question.name,
        "worst": found.worst,
        "worst_error": found.worst_error,
        "speed": found.point.speed,
        "torque": found.point.torque,
    }


def write_plan(plan: Plan, folder: Path) -> list[Path]:
    """Write `scene.toml`, with the chosen model, and `plan.json`; returns their names.

    Raises:
        HerringboneError: they cannot be written.
    """
    texts = {
        SCENE: scene_text(plan.scene),
        SUMMARY: json.dumps(plan_summary(plan), indent=1) + "\n",
    }
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            write_whole(folder / name, text)
    except OSError as error:
        raise HerringboneError(f"cannot write {folder}: {reason(error)}") from error
    return [folder / name for name in texts]
