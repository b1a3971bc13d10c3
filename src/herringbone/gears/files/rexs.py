"""REXS files: the cylindrical stage of a gear unit model, read into a gear pair.

The Reusable Engineering EXchange Standard (rexs.info) describes gear units in XML: components with
attributes that have a unit, and relations between components. A pair is taken from

    cylindrical_stage               center_distance
    cylindrical_gear (gear_1, 2)    number_of_teeth, normal_module, face_width,
                                    helix_angle_reference_diameter; optional tip_diameter,
                                    inner_diameter
    cylindrical_gear_flank, stage gear data, tool: whatever is related to a gear
                                    normal_pressure_angle, addendum_modification_coefficient;
                                    optional addendum_coefficient_reference_profile (of the tool:
                                    the gear's dedendum)
    material                        optional elastic_modulus, poisson_ratio, density

Both gears must have the same module, pressure angle and, but for the hand, helix angle.
"""

import math
from pathlib import Path
from typing import Any, NamedTuple

from herringbone.core import ResourceError
from herringbone.core.reading.numbers import number
from herringbone.core.reading.texts import read_bytes
from herringbone.core.reading.xml import LARGEST_XML, parse_xml
from herringbone.gears.files.quantity import in_si
from herringbone.gears.geometry.gear_pair import GearPair

_STAGE = "cylindrical_stage"
STAGE_MARK = "#"
"""Between the file and the id or name of a stage, where one text names both."""
_GEAR = "cylindrical_gear"
_SAME = 1e-6


class _Component(NamedTuple):
    name: str
    type: str
    attributes: dict[str, tuple[str, str]]


class _Model(NamedTuple):
    file: Path
    components: dict[str, _Component]
    relations: list[list[tuple[str, str]]]


def read_rexs(file: str | Path, *, stage: str | None = None, halves: int = 1) -> GearPair:
    """Read a stage of a REXS file.

    Args:
        file: XML file.
        stage: id or name of the cylindrical stage; needed if there are several.
        halves: 2 if the stage stands for a double-helical pair with the face width of one half.

    Raises:
        ResourceError: not readable, no such stage, a missing attribute, or another unit.
        ParameterError: the gears cannot mesh.
    """
    file = Path(file)
    model = _read(file)
    found = _stage(model, stage)
    gears = _gears(model, found)
    module = _shared(model, gears, "normal_module", "length")
    angle = _shared(model, gears, "normal_pressure_angle", "angle")
    helix = [_value(model, g, "helix_angle_reference_diameter", "angle") for g in gears]
    if abs(helix[0] + helix[1]) > _SAME:
        raise ResourceError(
            f"{file}: helix angles {math.degrees(helix[0]):g} and {math.degrees(helix[1]):g} deg "
            "of an external pair must be opposite"
        )
    width = min(_value(model, gear, "face_width", "length") for gear in gears)
    tips = [_optional(model, gear, "tip_diameter", "length") for gear in gears]
    bores = [_optional(model, gear, "inner_diameter", "length") for gear in gears]
    tool = [_optional(model, g, "addendum_coefficient_reference_profile", "number") for g in gears]
    optional: dict[str, Any] = {
        "tip_radius": [None if tip is None else 0.5 * tip for tip in tips],
        "bore_diameter": [bore or 0.0 for bore in bores],
        "dedendum_coefficient": [1.25 if height is None else height for height in tool],
        **_material(model, gears),
    }
    shift = [_value(model, g, "addendum_modification_coefficient", "number") for g in gears]
    return GearPair(
        number_of_teeth=[_teeth(model, gear) for gear in gears],
        normal_module=module,
        normal_pressure_angle=angle,
        helix_angle=helix[0],
        face_width=width,
        halves=halves,
        center_distance=_number(model, found, "center_distance", "length"),
        profile_shift_coefficient=shift,
        **optional,
    )


def _read(file: Path) -> _Model:
    root = parse_xml(read_bytes(file, LARGEST_XML), str(file))
    if root.tag != "model":
        raise ResourceError(f"{file}: root element '{root.tag}' is not the 'model' of a REXS file")
    components = {
        element.get("id", ""): _Component(
            element.get("name", "") or element.get("id", ""),
            element.get("type", ""),
            {
                item.get("id", ""): ((item.text or "").strip(), item.get("unit", ""))
                for item in element.findall("attribute")
            },
        )
        for element in root.findall("components/component")
    }
    relations = [
        [(ref.get("role", ""), ref.get("id", "")) for ref in relation.findall("ref")]
        for relation in root.findall("relations/relation")
    ]
    return _Model(file, components, relations)


def _stage(model: _Model, wanted: str | None) -> str:
    stages = {i: c.name for i, c in model.components.items() if c.type == _STAGE}
    names = ", ".join(f"{i} ({name})" for i, name in stages.items())
    if not stages:
        raise ResourceError(f"{model.file}: it has no {_STAGE}")
    if wanted is None:
        if len(stages) > 1:
            raise ResourceError(
                f"{model.file}: it has several stages, {names}; choose one by --stage, or as "
                f"{model.file}{STAGE_MARK}{next(iter(stages))} where a gearbox takes the file"
            )
        return next(iter(stages))
    found = [i for i, name in stages.items() if wanted in {i, name}]
    if len(found) != 1:
        raise ResourceError(f"{model.file}: stage '{wanted}' is none of {names}")
    return found[0]


def _gears(model: _Model, stage: str) -> list[str]:
    for relation in model.relations:
        roles = {role: i for role, i in relation}
        if roles.get("stage") == stage and {"gear_1", "gear_2"} <= set(roles):
            gears = [roles["gear_1"], roles["gear_2"]]
            if all(g in model.components and model.components[g].type == _GEAR for g in gears):
                return gears
    raise ResourceError(
        f"{model.file}: stage '{model.components[stage].name}' has no relation to two "
        f"{_GEAR}s with the roles gear_1 and gear_2"
    )


def _related(model: _Model, gear: str) -> list[str]:
    """The gear, and the components that a relation ties to it as its flanks, data or tool."""
    related = [gear]
    for relation in model.relations:
        if ("gear", gear) in relation:
            related += [i for role, i in relation if role not in {"gear", "stage"}]
    return [i for i in related if i in model.components]


def _number(model: _Model, component: str, name: str, kind: str) -> float:
    found = model.components[component]
    where = f"{model.file}: {found.type} '{found.name}', {name}"
    if name not in found.attributes:
        raise ResourceError(f"{where} is missing")
    text, unit = found.attributes[name]
    try:
        value = number(text)
    except ValueError as error:
        raise ResourceError(f"{where}: {error}") from None
    return in_si(value, unit, kind, where)


def _optional(model: _Model, gear: str, name: str, kind: str) -> float | None:
    owners = [i for i in _related(model, gear) if name in model.components[i].attributes]
    values = [_number(model, i, name, kind) for i in owners]
    if values and max(values) - min(values) > _SAME:
        raise ResourceError(
            f"{model.file}: {_GEAR} '{model.components[gear].name}' has several values of {name}; "
            "only equal flanks are read"
        )
    return values[0] if values else None


def _value(model: _Model, gear: str, name: str, kind: str) -> float:
    value = _optional(model, gear, name, kind)
    return _number(model, gear, name, kind) if value is None else value


def _teeth(model: _Model, gear: str) -> int:
    value = _value(model, gear, "number_of_teeth", "number")
    return int(value) if value == int(value) else value  # type: ignore[return-value]  # GearPair refuses it


def _shared(model: _Model, gears: list[str], name: str, kind: str) -> float:
    first, second = (_value(model, gear, name, kind) for gear in gears)
    if abs(first - second) > _SAME:
        raise ResourceError(f"{model.file}: {name} of both gears must be the same")
    return first


def _material(model: _Model, gears: list[str]) -> dict[str, float]:
    """Material that the first gear, or the shaft that carries it, refers to."""
    shafts = {
        i for r in model.relations if ("part", gears[0]) in r for role, i in r if role == "assembly"
    }
    for relation in model.relations:
        roles = dict(relation)
        material = roles.get("referenced", "")
        if roles.get("origin") not in {gears[0], *shafts} or material not in model.components:
            continue
        if model.components[material].type == "material":
            named = (
                ("youngs_modulus", "elastic_modulus", "stress"),
                ("poissons_ratio", "poisson_ratio", "number"),
                ("density", "density", "density"),
            )
            has = model.components[material].attributes
            return {to: _number(model, material, n, kind) for to, n, kind in named if n in has}
    return {}
