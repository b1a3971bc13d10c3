"""Units that connectors of an .ssp file declare, beside those of the FMUs' variables.

This master converts by what FMUs declare. Where a connector says otherwise, another master would
exchange other values, and the file is refused.
"""

from collections.abc import Iterable, Mapping
from typing import NamedTuple
from xml.etree.ElementTree import Element

from herringbone.core.part import PartVariable
from herringbone.cosim.ssp.content import Content
from herringbone.cosim.ssp.format import NAMESPACES
from herringbone.cosim.ssp.units import WITHOUT, Unit, declared_unit, definitions, unit_of


class Ends(NamedTuple):
    """A connection of two components.

    Attributes:
        first, second: `part.variable`.
        near_first, near_second: units of the connectors of nested systems between, "" without: the
            one that is nearest to each end.
    """

    first: str
    second: str
    near_first: str
    near_second: str


class ConnectorUnits:
    """Units of the components' connectors.

    Args:
        root: of the system structure, which defines the units.
        content: of the file, for messages.

    Attributes:
        untold: values that were given in units, of variables for which nothing declares one.

    Raises:
        StructureError: a definition has a value that is no number.
    """

    def __init__(self, root: Element, content: Content) -> None:
        self._content = content
        self._definitions = definitions(root, "ssd:Units", content)
        self._alone: dict[str, Unit] = {}
        self.untold: list[str] = []

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
            unit = self._named(declared_unit(connector))
            if unit is None or (variable := variables.get(name)) is None:
                continue
            own = unit_of(variable)
            if own is None:
                self._alone[f"{part}.{name}"] = unit
            elif not unit.same(own):
                raise self._content.refusal(
                    f"component '{component.get('name')}', connector '{name}': "
                    f"{unit.differs(own)} of the FMU's variable; give the connector that unit"
                )

    def check_value(
        self, path: str, given: Unit, variable: PartVariable | None, where: str
    ) -> None:
        """Check the unit of a value, which is taken in that of its variable, or else connector.

        Args:
            path: `part.variable` that it sets.
            given: its unit.
            variable: that it sets; None: it is not known.
            where: it stands, for messages.

        Raises:
            StructureError: it is another unit.
        """
        own, of = unit_of(variable), "of the variable"
        if own is None:
            own, of = self._alone.get(path), "of the connector"
        if own is not None and not given.same(own):
            raise self._content.refusal(f"{where}: {given.differs(own)} {of}; convert it")
        if own is None and variable is not None and given.name not in WITHOUT:
            self.untold.append(f"{path} [{given.name}]")

    def check(self, connections: Iterable[Ends], variables: Mapping[str, PartVariable]) -> None:
        """Check the connections at which an FMU declares no unit, but a connector does.

        Args:
            connections: of components.
            variables: of all parts, by `part.variable`.

        Raises:
            StructureError: the unit at the other end is another one.
        """
        for first, second, *between in connections:
            own = [unit_of(variables.get(end)) for end in (first, second)]
            units = [
                unit or self._alone.get(end) or self._named(name)
                for unit, end, name in zip(own, (first, second), between, strict=True)
            ]
            if None in own and units[0] and units[1] and not units[0].same(units[1]):
                raise self._content.refusal(
                    f"connection '{first}' - '{second}': {units[0].differs(units[1])}, and not "
                    "both FMUs declare theirs, by which values would be converted; declare them "
                    "there, or connect equal units"
                )

    def _named(self, name: str) -> Unit | None:
        return Unit(name, self._definitions.get(name)) if name else None
