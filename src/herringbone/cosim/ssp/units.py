"""Units as an .ssp file or an FMU names and defines them."""

import math
from collections.abc import Mapping
from typing import NamedTuple
from xml.etree.ElementTree import Element

from herringbone.core.names import shown
from herringbone.core.part import PartVariable
from herringbone.core.reading.numbers import number, whole
from herringbone.cosim.ssp.content import Content
from herringbone.cosim.ssp.format import NAMESPACES

WITHOUT = frozenset({"", "1", "-"})
"""Units of numbers without one."""
_ROUNDED = 1e-3
"""Share by which tools round the factor of one unit."""


class Unit(NamedTuple):
    """A unit's name, and factor, offset and base-unit exponents; None if they are not known."""

    name: str
    definition: tuple | None

    def same(self, other: "Unit") -> bool:
        """True if both have one definition, or one name that is not defined in two ways."""
        if self.definition is None or other.definition is None:
            return self.name == other.name
        if self.name != other.name:
            return self.definition == other.definition
        return _alike(self.definition, other.definition)

    def differs(self, other: "Unit") -> str:
        """In words, that it is not another one."""
        if self.name == other.name:
            return f"unit {shown(self.name)} is defined otherwise than {shown(other.name)}"
        return f"unit {shown(self.name)} is not {shown(other.name)}"


def definitions(element: Element, where: str, content: Content) -> Mapping[str, tuple]:
    """Definitions of units by name, as `PartVariable.dimension` has them.

    Args:
        element: a system structure or a parameter set.
        where: tag of its list of units.
        content: of the file, for messages.

    Raises:
        StructureError: a definition has a value that is no number.
    """
    return {
        unit.get("name", ""): _definition(unit, base, content)
        for unit in element.iterfind(f"{where}/ssc:Unit", NAMESPACES)
        for base in unit.iterfind("ssc:BaseUnit", NAMESPACES)
    }


def declared_unit(connector: Element) -> str:
    """Name of the unit that a connector declares; "" without."""
    return next(filter(None, (child.get("unit") for child in connector)), "")


def unit_of(variable: PartVariable | None) -> Unit | None:
    """The unit that an FMU declares."""
    return Unit(variable.unit, variable.dimension) if variable and variable.unit else None


def _definition(unit: Element, base: Element, content: Content) -> tuple:
    given = dict(base.attrib)
    try:
        factor, offset = number(given.pop("factor", "1")), number(given.pop("offset", "0"))
        powers = tuple(sorted((n, whole(text)) for n, text in given.items() if whole(text)))
    except ValueError as error:
        raise content.refusal(f"unit {shown(unit.get('name', ''))}: {error}") from None
    return factor, offset, powers


def _alike(first: tuple, second: tuple) -> bool:
    """True if definitions of one name agree: rad may be missing, and a difference has no offset."""
    (factor, _, powers), (other, _, others) = first, second
    bases, own = ({n: p for n, p in each if n != "rad"} for each in (powers, others))
    return bases == own and math.isclose(factor, other, rel_tol=_ROUNDED)
