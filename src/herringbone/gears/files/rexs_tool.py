"""Roots of gears in a REXS file: by the tool that cuts the gear, or by its root diameter.

Since REXS 1.3 a relation ties each flank (workpiece) to the tool and the settings of a step of its
manufacturing; before, one ties the gear (origin) to the tool (referenced). Only the tip of the
tool's profile is read: what else a tool has by the name of an attribute of gears is its own.
"""

import math
import re
from collections.abc import Iterator
from typing import NamedTuple

from herringbone.core import ResourceError
from herringbone.gears.files.rexs_model import (
    SAME,
    Model,
    attribute,
    named,
    optional,
    present,
    related,
    value_of,
)

CUTTER = "cutter_wheel_tool"
_TOOLS = {CUTTER, "rack_shaped_tool", "zero_degree_grinding_disk_tool"}
_ADDENDUM = "addendum_coefficient_reference_profile"
_RADII = ("tip_radius_factor", "tip_corner_radius_factor_reference_profile")
"""Tip radius over module; the second since REXS 2.0."""
_UNREAD = re.compile("protuberance_(amount|height).*|generated_addendum_modification_coefficient.*")
_BASIS = (("normal_module", "length"), ("normal_pressure_angle", "angle"))


class Root(NamedTuple):
    """Dedendum and fillet radius of a gear in modules, None where the file has none, and lines."""

    dedendum: float | None
    fillet: float | None
    lines: tuple[str, ...]


class _Step(NamedTuple):
    workpiece: str
    tool: str
    settings: str


def root_of(model: Model, gear: str) -> Root:
    """The root of a gear by its tool, the last of several, or else by its root diameter.

    Raises:
        ResourceError: an attribute is no number; or the tools of both flanks differ.
    """
    steps = list(_steps(model, gear))
    last = {step.workpiece: step for step in steps if _cuts(model, gear, step.tool)}
    if not last:
        tools = list(dict.fromkeys(step.tool for step in steps))
        lines = (f"{_cut_by(model, gear, tools)}: {_UNFIT}",) if tools else ()
        return Root(_by_diameter(model, gear), None, lines)
    profiles = [_profile(model, step.tool) for step in last.values()]
    for name, values in zip((_ADDENDUM, _RADII[0]), zip(*profiles, strict=True), strict=True):
        if any(_differ(values[0], value) for value in values):
            raise ResourceError(
                f"{model.file}: {named(model, gear)}: the tools of its flanks differ in {name}; "
                "only equal flanks are read"
            )
    taken = next(iter(last.values()))
    tools = [step.tool for step in steps if step.workpiece == taken.workpiece]
    return Root(*profiles[0], tuple(_lines(model, gear, tools, taken)))


_UNFIT = f"not read for want of {_ADDENDUM}, or by another module or pressure angle than the gear's"


def _by_diameter(model: Model, gear: str) -> float | None:
    """h_fP = (d - d_f) / (2 m_n) + x, if there is a root diameter."""
    root = optional(model, gear, "root_diameter", "length")
    if not root:
        return None
    module = value_of(model, gear, "normal_module", "length")
    teeth = value_of(model, gear, "number_of_teeth", "number")
    helix = value_of(model, gear, "helix_angle_reference_diameter", "angle")
    shift = value_of(model, gear, "addendum_modification_coefficient", "number")
    if module == 0.0:
        return None
    return 0.5 * (teeth / math.cos(helix) - root / module) + shift


def _steps(model: Model, gear: str) -> Iterator[_Step]:
    """Tools of the gear or its flanks, in the order of their steps."""
    own = set(related(model, gear))
    for relation in model.relations:
        roles = dict(relation)
        piece = roles.get("workpiece", roles.get("origin", ""))
        tool = roles.get("tool", roles.get("referenced", ""))
        if piece in own and tool in model.components and model.components[tool].type in _TOOLS:
            yield _Step(piece, tool, roles.get("manufacturing_settings", ""))


def _cuts(model: Model, gear: str, tool: str) -> bool:
    """True if the tool has the profile's addendum, in the module of the gear."""
    has = model.components[tool].attributes
    basis = [(name, kind) for name, kind in _BASIS if name in has]
    return _ADDENDUM in has and not any(
        _differ(attribute(model, tool, name, kind), optional(model, gear, name, kind))
        for name, kind in basis
    )


def _profile(model: Model, tool: str) -> tuple[float, float | None]:
    has = model.components[tool].attributes
    radius = next((name for name in _RADII if name in has), None)
    return (
        attribute(model, tool, _ADDENDUM, "number"),
        None if radius is None else attribute(model, tool, radius, "number"),
    )


def _differ(one: float | None, other: float | None) -> bool:
    if one is None or other is None:
        return one is not other
    return abs(one - other) > SAME


def _lines(model: Model, gear: str, tools: list[str], taken: _Step) -> Iterator[str]:
    cut = _cut_by(model, gear, tools)
    if len(tools) > 1:
        yield f"{cut}: the root is that of {named(model, taken.tool)}, the last"
    if model.components[taken.tool].type == CUTTER:
        yield f"{cut}: the root is that of a rack with the cutter's addendum"
    if left := [*present(model, taken.tool, _UNREAD), *present(model, taken.settings, _UNREAD)]:
        yield f"{cut}; not read: {', '.join(left)}"


def _cut_by(model: Model, gear: str, tools: list[str]) -> str:
    listed = ", ".join(named(model, tool) for tool in tools)
    return f"{model.file}: {named(model, gear)} is cut by {listed}"
