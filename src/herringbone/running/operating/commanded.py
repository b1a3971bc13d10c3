"""Speed and torque of an operating point, as values of variables."""

import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from numbers import Real
from pathlib import Path

from herringbone.analysis.anatomy import anatomy, check_numbers, value_at
from herringbone.analysis.set_points import (
    QUANTITIES,
    SPEED,
    TORQUE,
    at_pinion,
    check_speed,
    pinion_teeth,
    set_point,
)
from herringbone.components.registry import component
from herringbone.core import HerringboneError, Instance, ParameterError
from herringbone.core.declaring.roles import Role
from herringbone.core.places.files import as_texts
from herringbone.cosim.structure.system import System
from herringbone.running.fitted import housings_of
from herringbone.running.housings.given import split_housings
from herringbone.running.loading import load_scene, system_and_folder, with_replacements
from herringbone.running.prepared import Wishes
from herringbone.scenes import Scene

Point = Mapping[str, float | str]
"""Values by parameter: `speed`, `torque`, or `instance.variable`."""


def commanded(system: System, point: Point) -> dict[str, float | str]:
    """A point whose speed [rad/s] and torque [N m] are values of variables.

    Args:
        system: with all values but these.
        point: speed, torque and others.

    Raises:
        HerringboneError: see `set_point`; or what commands cannot have the value.
    """
    values = dict(point)
    asked = {name: float(values.pop(name)) for name in QUANTITIES if name in point}
    for name, value in asked.items():
        values |= _values(system, name, value)
    return values


def with_known_values(system: System, scene: Scene, wishes: Wishes) -> System:
    """A system with what decides on its set points: values and replaced parts.

    Raises:
        HerringboneError: a value is no number, or an FMU cannot be used.
    """
    fmus = split_housings(housings_of(system, scene, wishes))[1]
    system, _ = with_replacements(system, {**wishes.replace_parts, **fmus}, probe=wishes.probe)
    system = system.with_values({**scene.values, **as_texts(wishes.values)})
    check_numbers(system)
    return system


def own_point(system: System) -> tuple[float | None, float | None]:
    """Speed [rad/s] and torque [N m] that a system has; None where nothing in it tells them.

    Args:
        system: with all its values.
    """
    found: dict[str, float] = {}
    for name in (SPEED, TORQUE):
        with suppress(HerringboneError, ValueError):
            ((path, share),) = _values(system, name, 1.0).items()
            found[name] = value_at(system, path) / share
    return found.get(SPEED), found.get(TORQUE)


def changing(system: System) -> list[str]:
    """Which of speed and torque parts command without a constant value, as of a run-up.

    Args:
        system: with all its values.
    """
    found = []
    for name, own in zip((SPEED, TORQUE), own_point(system), strict=True):
        with suppress(HerringboneError):
            at = set_point(system, name)
            if own is None and at is not None and not at.given:
                found.append(name)
    return found


def operated(
    system: str | Path | System,
    scene: str | Path | Scene | None,
    wishes: Wishes,
    speed: float | None,
    torque: float | None,
) -> Wishes:
    """Wishes with the values that stand for an operating point.

    Args:
        system, scene: see `herringbone.run`.
        wishes: over these.
        speed: of the speed set point [rad/s]; None: the scene's.
        torque: of the torque set point [N m], likewise.

    Raises:
        HerringboneError: see `commanded`; or a value that stands for it is given besides.
    """
    asked = {n: v for n, v in ((SPEED, speed), (TORQUE, torque)) if v is not None}
    if not asked:
        return wishes
    for name, value in asked.items():
        if not isinstance(value, Real) or not math.isfinite(value):
            raise ParameterError(f"{name} = {value!r}: it must be a finite number")
    structure, folder = system_and_folder(system)
    known = with_known_values(structure, load_scene(folder, scene), wishes)
    if speed is not None:
        _check_speed(known, speed)
    given = {known.split(path): path for path in wishes.values}
    for name, value in asked.items():
        values = _values(known, name, value)
        if twice := [given[known.split(path)] for path in values if known.split(path) in given]:
            raise ParameterError(f"{name} decides on {twice[0]}, which is given besides; drop one")
        wishes = replace(wishes, values={**wishes.values, **values})
    return wishes


def _check_speed(system: System, speed: float) -> None:
    """Raise ParameterError if the teeth of the first pair could not mesh so fast."""
    for pair in anatomy(system).with_role(Role.GEAR_PAIR)[:1]:
        if teeth := pinion_teeth(system, pair):
            check_speed(speed, teeth)


def _values(system: System, name: str, value: float) -> dict[str, float]:
    found = set_point(system, name)
    if found is None:
        return dict(at_pinion(system, **{name: value}))
    if found.given:
        return {str(found): value}
    part = system.part(found.part)
    instance = Instance(component(str(part.component)), found.part)
    if instance.component.commanded is None:
        raise ParameterError(f"{name}: {found} takes no value from outside; vary what it has")
    for variable, given in part.values.items():
        instance.set(variable, given)
    instance.load_resources()
    try:
        values = instance.component.commanded(instance.block, QUANTITIES[name], value)
    except ParameterError as error:
        raise ParameterError(f"{name}: {found.part}: {error}") from None
    return {f"{found.part}.{variable}": factor for variable, factor in values.items()}
