"""A run of several gearboxes, as one run per gearbox: figures and pictures of each alone."""

from collections.abc import Iterable
from dataclasses import replace

from herringbone.analysis.asked import group
from herringbone.core.declaring.roles import Role
from herringbone.core.places.part_path import PartPath
from herringbone.result.result import Result

_INSIDE = Role.GEAR_PAIR, Role.BEARING, Role.HOUSING
"""Shafts, rotors and the rest belong to all gearboxes that they are joined to."""


def by_gearbox(result: Result) -> dict[str, Result]:
    """The run once per nested system that has gear pairs, by its path; "" is the system itself.

    Each shows nothing of the gear pairs, bearings and housings of the others. A run whose gear
    pairs all stand in one system, or that has none, is returned as it is.
    """
    scopes = tuple(dict.fromkeys(PartPath(gear).scope for gear in _parts(result, Role.GEAR_PAIR)))
    if len(scopes) < 2:
        return {"": result}
    owners = {part: _owner(part, scopes) for part in _parts(result, *_INSIDE)}
    return {
        scope: _without(result, [part for part, owner in owners.items() if owner != scope], scope)
        for scope in scopes
    }


def gearbox_of_sensor(result: Result, sensor: str) -> Result:
    """The run of the gearbox on which a sensor sits; the whole one if it sits on none alone."""
    owns = (own for own in by_gearbox(result).values() if sensor in own.info.sensors)
    return next(owns, result)


def _parts(result: Result, *roles: Role) -> list[PartPath]:
    return [PartPath(part) for role in roles for part in result.parts_with(role)]


def _owner(part: PartPath, scopes: Iterable[str]) -> str:
    """The innermost of the systems that contain a part."""
    around = [scope for scope in scopes if not scope or part.startswith(f"{scope}.")]
    return max(around, key=len, default="")


def _without(result: Result, dropped: Iterable[str], scope: str) -> Result:
    hidden = tuple(f"{part}." for part in dropped)
    channels = {
        name: tuple(c for c in group(result, name) if not c.startswith(hidden))
        for name in result.channels
    }
    info = replace(
        result.info,
        system=".".join(filter(None, (result.info.system, scope))),
        anatomy=result.info.anatomy.without(dropped),
        sensors={k: v for k, v in result.info.sensors.items() if v.part not in set(dropped)},
    )
    shown = {name: columns for name, columns in channels.items() if columns}
    return replace(result, info=info, channels=shown)
