"""Units that connectors of an .ssp file declare, beside those of the FMUs' variables.

This master converts by what FMUs declare. Where a connector says otherwise, another master would
exchange other values, and the file is refused.
"""

from collections.abc import Iterable, Mapping
from typing import NamedTuple
from xml.etree.ElementTree import Element

from herringbone.core.names import shown
from herringbone.core.part import PartVariable
from herringbone.core.reading.numbers import number, whole
from herringbone.cosim.ssp.content import Content
from herringbone.cosim.ssp.format import NAMESPACES


class _Unit(NamedTuple):
    """A unit's name, and factor, offset and base-unit exponents; None if they are not known."""

    name: str
    definition: tuple | None

    def same(self, other: "_Unit") -> bool:
        """True if both have one name or one definition."""
        return self.name == other.name or (
            self.definition is not None and self.definition == other.definition
        )


class ConnectorUnits:
    """Units of the components' connectors.

    Args:
        root: of the system structure, which defines the units.
        content: of the file, for messages.

    Raises:
        StructureError: a definition has a value that is no number.
    """

    def __init__(self, root: Element, content: Content) -> None:
        self._content = content
        self._definitions = {
            unit.get("name", ""): self._definition(unit, base)
            for unit in root.iterfind("ssd:Units/ssc:Unit", NAMESPACES)
            for base in unit.iterfind("ssc:BaseUnit", NAMESPACES)
        }
        self._alone: dict[str, _Unit] = {}

    def _definition(self, unit: Element, base: Element) -> tuple:
        """As `PartVariable.dimension` has it."""
        given = dict(base.attrib)
        try:
            factor, offset = number(given.pop("factor", "1")), number(given.pop("offset", "0"))
            powers = tuple(sorted((n, whole(text)) for n, text in given.items() if whole(text)))
        except ValueError as error:
            raise self._content.refusal(f"unit {shown(unit.get('name', ''))}: {error}") from None
        return factor, offset, powers

    def take(self, component: Element, part: str, variables: Mapping[str, PartVariable]) -> None:
        """Note the units of a component's connectors whose variables have none; check the others.

        Args:
            component: as the file has it.
            part: what it is called here.
            variables: of its FMU, by name.

        Raises:
            StructureError: a connector's unit is not that of its variable.
        """
        for connector in component.iterfind("ssd:Connectors/ssd:Connector", NAMESPACES):
            name = connector.get("name", "")
            declared = next(filter(None, (child.get("unit") for child in connector)), None)
            if declared is None or (variable := variables.get(name)) is None:
                continue
            unit, own = _Unit(declared, self._definitions.get(declared)), _own(variable)
            if own is None:
                self._alone[f"{part}.{name}"] = unit
            elif not unit.same(own):
                raise self._content.refusal(
                    f"component '{component.get('name')}', connector '{name}': unit "
                    f"{shown(unit.name)} is not {shown(own.name)} of the FMU's variable; give the "
                    "connector that unit"
                )

    def check(
        self, connections: Iterable[tuple[object, object]], variables: Mapping[str, PartVariable]
    ) -> None:
        """Check the connections at which an FMU declares no unit, but a connector does.

        Args:
            connections: two `part.variable` each; others are passed over.
            variables: of all parts, by `part.variable`.

        Raises:
            StructureError: the unit at the other end is another one.
        """
        for ends in connections:
            first, second = (
                self._alone.get(str(end)) or _own(variables.get(str(end))) for end in ends
            )
            alone = any(str(end) in self._alone for end in ends)
            if alone and first and second and not first.same(second):
                raise self._content.refusal(
                    f"connection '{ends[0]}' - '{ends[1]}': units differ, {shown(first.name)} and "
                    f"{shown(second.name)}, and not both FMUs declare theirs, by which values "
                    "would be converted; declare them there, or connect equal units"
                )


def _own(variable: PartVariable | None) -> _Unit | None:
    """The unit that an FMU declares."""
    return _Unit(variable.unit, variable.dimension) if variable and variable.unit else None
