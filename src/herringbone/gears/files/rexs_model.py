"""Components, attributes and relations of a REXS file, and values by their names.

Errors say file, component and attribute.
"""

import re
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

from herringbone.core import ResourceError
from herringbone.core.reading.numbers import number
from herringbone.core.reading.texts import read_bytes
from herringbone.core.reading.xml import LARGEST_XML, parse_xml
from herringbone.gears.files.quantity import in_si

GEAR = "cylindrical_gear"
SAME = 1e-6
"""Values that differ by less are the same."""


class Component(NamedTuple):
    """A component: its name, its type, and (text, unit) of its attributes by id."""

    name: str
    type: str
    attributes: dict[str, tuple[str, str]]


class Model(NamedTuple):
    """A file: components by id, and relations as lists of (role, id of a component).

    Relations that are steps of a sequence come in its order.
    """

    file: Path
    components: dict[str, Component]
    relations: list[list[tuple[str, str]]]


def read_model(file: Path) -> Model:
    """Read a file.

    Raises:
        ResourceError: not readable, or no REXS model.
    """
    root = parse_xml(read_bytes(file, LARGEST_XML), str(file))
    if root.tag != "model":
        raise ResourceError(f"{file}: root element '{root.tag}' is not the 'model' of a REXS file")
    components = {
        element.get("id", ""): Component(
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
        for relation in sorted(root.findall("relations/relation"), key=_order)
    ]
    return Model(file, components, relations)


def _order(relation: Element) -> float:
    try:
        return number(relation.get("order", "0"))
    except ValueError:
        return 0.0


def named(model: Model, component: str) -> str:
    """How messages call a component: cylindrical_gear 'Pinion'."""
    found = model.components[component]
    return f"{found.type} '{found.name}'"


def related(model: Model, gear: str) -> list[str]:
    """The gear, and the components that a relation ties to it as its flanks or data."""
    tied = [gear]
    for relation in model.relations:
        if ("gear", gear) in relation:
            tied += [i for role, i in relation if role not in {"gear", "stage", "tool"}]
    return [i for i in tied if i in model.components]


def present(model: Model, component: str, pattern: re.Pattern[str]) -> list[str]:
    """Attributes whose names match and that say something, such as 'tip_relief = 5 mum'."""
    found = model.components.get(component)
    given = found.attributes.items() if found else ()
    return [
        f"{name} = {text} {unit}".removesuffix(" none").strip()
        for name, (text, unit) in given
        if pattern.fullmatch(name) and text and not _is_zero(text)
    ]


def _is_zero(text: str) -> bool:
    try:
        return number(text) == 0.0
    except ValueError:
        return False


def attribute(model: Model, component: str, name: str, kind: str) -> float:
    """An attribute of a component, in SI units.

    Raises:
        ResourceError: it is missing, no number, or in a unit of another kind.
    """
    where = f"{model.file}: {named(model, component)}, {name}"
    attributes = model.components[component].attributes
    if name not in attributes:
        raise ResourceError(f"{where} is missing")
    text, unit = attributes[name]
    try:
        value = number(text)
    except ValueError as error:
        raise ResourceError(f"{where}: {error}") from None
    return in_si(value, unit, kind, where)


def optional(model: Model, gear: str, name: str, kind: str) -> float | None:
    """An attribute of a gear or of what is related to it, in SI units; None if there is none.

    Raises:
        ResourceError: see `attribute`; or its flanks differ.
    """
    owners = [i for i in related(model, gear) if name in model.components[i].attributes]
    values = [attribute(model, i, name, kind) for i in owners]
    if values and max(values) - min(values) > SAME:
        raise ResourceError(
            f"{model.file}: {named(model, gear)} has several values of {name}; only equal flanks "
            "are read"
        )
    return values[0] if values else None


def value_of(model: Model, gear: str, name: str, kind: str) -> float:
    """As `optional`, of an attribute that must be there."""
    value = optional(model, gear, name, kind)
    return attribute(model, gear, name, kind) if value is None else value
