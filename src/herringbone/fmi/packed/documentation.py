"""Documentation of an FMU: equations, signs, variables and their ranges."""

import html
import json
import math
from collections.abc import Iterable
from importlib.metadata import distribution
from typing import TYPE_CHECKING

from herringbone.core import Component, Declaration, Variable
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.declaring.units import quantity
from herringbone.core.declaring.variable import Causality, Variability
from herringbone.fmi import interface

if TYPE_CHECKING:
    from herringbone.fmi.native.platforms import Platform

FLANGE_MODELS = "extra/herringbone/flange_models.json"
"""Place in an FMU of its linear equations as its flanges feel them, by flange."""
_UNTESTED = "built, not run"
_OF_START = ".guess_", ".start."
_HEAD = ("name", "causality", "unit", "start", "range", "description")
_SIGNS = (
    "SI units; tools may show others. Forces and torques are those that act on the body whose "
    "motion is given: a torque input drives the gearbox where it is positive, a torque output acts "
    "on what the host has at that flange. Both flanges turn positively in driving direction. Left "
    "is +z; in the housing's frame x points to the wheel and y up; in the gear's frame y is the "
    "line of action of the flank that carries."
)
_HOSTED = (
    "A flange that takes motion has its shaft inside; angles count from the start, where the shaft "
    "has its initial torque. An angle that is not set runs on as the integral of w, also where w "
    "alone is set; if the host gives derivatives of phi, these alone count. tau_mean is the mean "
    "of tau over the last communication step: its product with the mean speed is the energy that "
    "was handed over. "
    "At the start the elastic coordinates vibrate as they do when all has settled under the "
    "torques. start_mode = equilibrium: they move as one with the gears, which is no part of that "
    "vibration, so that another one rings down; as_set: they start undeformed, or as states are "
    "set, which count there alone. The pinion's angle starts at 0; `herringbone run` starts at the "
    "angle where the torques balance, so that its rows are not those of this FMU. The tolerance "
    "that the host gives, or that of the default experiment, decides inner steps: relative, of "
    "states by the largest of their kind."
)


_STEPS = (
    "Largest stable communication steps at the start, with an inertia at one flange and nothing "
    "else at the others, where the host evaluates its shaft at the communication points; inputs "
    "held, or with their first derivatives. `herringbone stability FILE.fmu --flange PORT "
    "--inertia J`, at a flange to which the host gives torque with `--stiffness K --damping D` of "
    "its shaft, asks for others, and for shafts that are stepped in parallel. Accuracy asks for "
    "less."
)


def documentation(component: Component, platforms: Iterable["Platform"]) -> bytes:
    """The page."""
    declaration = component.declaration
    binaries = "".join(
        f"<li>{p.name}{'' if p.tested else f' ({_UNTESTED})'}</li>" for p in platforms
    )
    hosted = fixed = ""
    if component.hosting:
        notes = "".join(f"<li>{html.escape(note)}</li>" for note in component.hosting.notes)
        hosted = (
            f"{f'<h2>Notes</h2><ul>{notes}</ul>' if notes else ''}"
            f"<h2>Flanges and start</h2><p>{html.escape(_HOSTED)}</p>"
            f"<h2>Communication steps</h2><p>{html.escape(_STEPS)}</p>"
            f"{_table(component.hosting.advice())}"
        )
        fixed = _fixed(declaration)
    text = (
        f"<!DOCTYPE html><html><head><meta charset='utf-8'><title>{component.name}</title></head>"
        f"<body><h1>{component.name}</h1><p>{html.escape(declaration.description)}.</p>"
        f"<h2>Binaries</h2><ul>{binaries}</ul>"
        f"<h2>Signs</h2><p>{html.escape(_SIGNS)}</p>{hosted}"
        f"<h2>Variables</h2>{_variables(component)}{fixed}"
        f"<h2>Equations</h2><pre>{html.escape(component.equations.strip())}</pre></body></html>\n"
    )
    return text.encode()


def communication_steps(component: Component) -> dict[str, bytes]:
    """What is known of communication steps: lines for messages, equations for `stability`."""
    if component.hosting is None:
        return {}
    _, *rows = component.hosting.advice()
    known: dict[tuple[str, str], list[str]] = {}
    for flange, _, there, held, slopes in rows:
        inertia, _, shaft = there.partition(" behind ")
        text = f"{held} with {inertia} ({slopes} with derivatives)"
        known.setdefault((flange, shaft and f", behind {shaft}"), []).append(text)
    lines = "".join(f"{f}: at most {', '.join(of)}{shaft}\n" for (f, shaft), of in known.items())
    models = json.dumps(component.hosting.models())
    return {"resources/communication_steps.txt": lines.encode(), FLANGE_MODELS: models.encode()}


def licence() -> bytes:
    """Text of the licence."""
    return (distribution("herringbone").read_text("licenses/LICENSE") or "MIT\n").encode()


def _variables(component: Component) -> str:
    shown = interface.reals(component.declaration).values()
    texts = (
        (t.name, "parameter", "", t.start, "", t.description)
        for t in interface.texts(component.declaration).values()
    )
    return _table([_HEAD, *map(_row, shown), *texts])


def _fixed(declaration: Declaration) -> str:
    """Parameters that are not shown, without those that the search for the start works with."""
    rows = [
        (v.name, v.unit, repr(float(v.start)), v.description)
        for v in interface.every_real(declaration).values()
        if v.causality is Causality.PARAMETER
        and v.name in declaration.hidden
        and v.name != INTERFACE_DEGREE
        and not any(of_start in v.name for of_start in _OF_START)
    ]
    head = "name", "unit", "value", "description"
    return f"<h2>Fixed at export</h2>{_table([head, *rows])}" if rows else ""


def _table(rows: Iterable[tuple[str, ...]]) -> str:
    """The first row is the head."""
    lines = [f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows]
    lines[0] = lines[0].replace("td>", "th>")
    return f"<table>{''.join(lines)}</table>"


def _cell(text: str) -> str:
    return f"<td>{html.escape(text)}</td>"


def _row(v: Variable) -> tuple[str, ...]:
    limits = (v.minimum, v.maximum)
    ends = [quantity(x, v.unit) if math.isfinite(x) else "" for x in limits]
    range_ = " ... ".join(ends) if any(ends) else ""
    if v.items:
        named = (f"{number}: {item}" for number, item in enumerate(v.items))
        kind = f"{v.causality}, enumeration"
        return v.name, kind, "", v.items[int(v.start)], ", ".join(named), v.description
    tunable = ", tunable" if v.variability is Variability.TUNABLE else ""
    start = repr(float(v.start)) if v.causality in {"input", "parameter"} else ""
    return v.name, f"{v.causality}{tunable}", v.unit, start, range_, v.description
