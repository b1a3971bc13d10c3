"""Reading SSP 1.0 files: a system of FMI 2.0 co-simulation FMUs, with parameter values.

What is not of that subset is refused by name; nothing is left out silently but geometry and the
annotations of other tools. SSP allows any names; what is no identifier is mapped to one (see
`core.names.identifier_for`), and a note says so.
"""

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree.ElementTree import Element

from herringbone.core import FmuError, StructureError
from herringbone.core.names import (
    check_name,
    check_path,
    first_of,
    identifier_for,
    is_identifier,
    shown,
)
from herringbone.core.part import PartVariable
from herringbone.core.places.part_path import PartPath
from herringbone.core.reading.numbers import number
from herringbone.cosim.fmu.file import read_fmu
from herringbone.cosim.fmu.variables import read_variables
from herringbone.cosim.ssp.connector_units import ConnectorUnits, Ends
from herringbone.cosim.ssp.content import Content
from herringbone.cosim.ssp.flatten import END_UNIT, START_UNIT, flat_path, flattened
from herringbone.cosim.ssp.format import (
    CHANNELS_ANNOTATION,
    FMU_TYPE,
    NAMESPACES,
    PARTS_ANNOTATION,
    SUPPRESS_CONVERSION,
    local_name,
    read_structure,
    suppresses_conversion,
    unpack,
)
from herringbone.cosim.ssp.parameters import parameters, value_of
from herringbone.cosim.ssp.ports import Outside, ports_of
from herringbone.cosim.structure.system import PartSpec, System

_TOLD = 3
"""Values that a note names."""


def read_ssp(file: str | Path) -> System:
    """The system of an .ssp file, or of a folder into which one was unpacked.

    The FMUs lie in a temporary folder that is removed when the process ends.

    Raises:
        StructureError: the file cannot be read or uses what this master does not know.
        FmuError: an FMU is not for co-simulation with FMI 2.0, or unusable.
    """
    file = Path(file)
    return _Reader(file, unpack(file)).system(read_structure(file))


def read_stop_time(file: str | Path) -> float | None:
    """Stop time of the default experiment [s], if there is one.

    Raises:
        StructureError: the file cannot be read.
    """
    file = Path(file)
    experiment = read_structure(file).find("ssd:DefaultExperiment", NAMESPACES)
    if experiment is None:
        return None
    found = {}
    for name in ("startTime", "stopTime"):
        text = experiment.get(name)
        try:
            found[name] = None if text is None else number(text)
        except ValueError:
            raise StructureError(f"{file}: {name} = '{text}' is no number") from None
    if found["startTime"]:
        raise StructureError(
            f"{file}: startTime = {found['startTime']:g} s: runs begin at 0 s; change the file"
        )
    return found["stopTime"]


@dataclass(frozen=True)
class _Reader(Content):
    """One file that is being read.

    Attributes:
        names: identifiers of the components, by their names in the file.
        notes: lines about names that were changed.
    """

    names: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def system(self, root: Element) -> System:
        element = root.find("ssd:System", NAMESPACES)
        if element is None:
            raise self.refusal("it contains no system")
        if element.find("ssd:SignalDictionaries", NAMESPACES) is not None:
            raise self.refusal("signal dictionaries are not supported; connect components directly")
        element, still = flattened(element, self.refusal)
        if still:
            self.notes.append(
                f"{self.file}: nothing arrives at {', '.join(still)}: what these inputs of nested "
                "systems lead to keeps its start values"
            )
        units = ConnectorUnits(root, self)
        name = self.renamed(element.get("name") or root.get("name") or self.file.stem, "system")
        self.name_components(element)
        parts: list[PartSpec] = []
        variables: dict[str, PartVariable] = {}
        for child in element.iterfind("ssd:Elements/*", NAMESPACES):
            part, part_variables = self.part(child, units)
            parts.append(part)
            variables |= part_variables
        values = self.values(element, "the system", variables, units)
        if units.untold:
            self.notes.append(
                f"{self.file}: neither FMU nor connector declares a unit for "
                f"{first_of(units.untold, _TOLD)}: the values are taken as they stand"
            )
        found = list(self.connections(element))
        inner = [each for each in found if isinstance(each, Ends)]
        units.check(inner, variables)
        system = System(
            name,
            element.get("description", ""),
            tuple(parts),
            tuple((each.first, each.second) for each in inner),
            ports=self.ports([each for each in found if isinstance(each, Outside)]),
            channels=self.channels(element),
            notes=tuple(self.notes),
        )
        return system.with_values(values)

    def renamed(self, name: str, kind: str, taken: Container[str] = ()) -> str:
        """The identifier for a name of the file; a note if it is another one."""
        found = identifier_for(name, taken)
        if found != name:
            self.notes.append(f"{self.file}: {kind} {shown(name)} is called {found} here")
        return found

    def name_components(self, system: Element) -> None:
        """Find the identifiers of all components; names that are some keep theirs."""
        names = [child.get("name", "") for child in system.iterfind("ssd:Elements/*", NAMESPACES)]
        if twice := [name for name in names if names.count(name) > 1]:
            raise self.refusal(f"component name {shown(twice[0])} stands twice; rename one")
        self.names.update({name: name for name in names if is_identifier(name)})
        self.names.update({name: path for name, path in self.paths(system) if name in names})
        for name in names:
            if name not in self.names and name:
                taken = set(self.names.values())
                self.names[name] = self.renamed(name, "component", taken)

    def paths(self, system: Element) -> Iterator[tuple[str, str]]:
        """Names of components and their paths, which this package writes as an annotation."""
        for annotation in system.iterfind("ssd:Annotations/ssc:Annotation", NAMESPACES):
            if annotation.get("type") == PARTS_ANNOTATION:
                for part in annotation.iterfind("hb:Parts/hb:Part", NAMESPACES):
                    path = check_path(part.get("path", ""), f"{self.file}: path of a part")
                    yield part.get("name", ""), path

    def path_here(self, path: str) -> str:
        """A path `component.variable` of the file, systems in front, with the identifiers here."""
        part, *rest = path.split(".")
        for count in range(len(rest)):
            if (found := self.names.get(flat_path([part, *rest[:count]]))) is not None:
                return ".".join([found, *rest[count:]])
        return path

    def part(
        self, element: Element, units: ConnectorUnits
    ) -> tuple[PartSpec, Mapping[str, PartVariable]]:
        """A component, and its variables by `part.variable`."""
        kind, name = local_name(element), element.get("name", "")
        if kind == "SignalDictionaryReference":
            raise self.refusal(
                f"signal dictionary reference '{name}' is not supported; connect directly"
            )
        if not name or "." in name:
            raise self.refusal(f"component name '{name}': it must not be empty or contain a dot")
        if (found := element.get("type", FMU_TYPE)) != FMU_TYPE:
            raise self.refusal(f"component '{name}' is of type {found}; an FMU is needed")
        if element.get("implementation", "any") not in {"any", "CoSimulation"}:
            raise self.refusal(f"component '{name}' wants model exchange; use co-simulation")
        fmu = self.path(element.get("source", ""), f"component '{name}'")
        try:
            variables = read_variables(read_fmu(fmu))
        except FmuError as error:
            raise FmuError(f"{self.file}: component '{name}': {error}") from error
        path = PartPath(self.names[name])
        units.take(element, path, variables)
        variables = {f"{path}.{n}": v for n, v in variables.items()}
        values = self.values(element, f"component '{name}'", variables, units, f"{path}.")
        return PartSpec(path, fmu=fmu, values=values), variables

    def connections(self, system: Element) -> Iterator[Ends | Outside]:
        for element in system.iterfind("ssd:Connections/ssd:Connection", NAMESPACES):
            ends = [
                (element.get(f"{end}Element"), element.get(f"{end}Connector"))
                for end in ("start", "end")
            ]
            where = "connection " + " - ".join(f"'{a or 'system'}.{b}'" for a, b in ends)
            if all(part is None for part, _ in ends) or any(name is None for _, name in ends):
                raise self.refusal(f"{where}: it needs connectors, and a component at one end")
            for child in element:
                if local_name(child) not in {"ConnectionGeometry", "Annotations"}:
                    raise self.refusal(f"{where}: {local_name(child)} is not supported")
            if suppresses_conversion(element):
                raise self.refusal(f"{where}: {SUPPRESS_CONVERSION} is not supported")
            (first, output), (second, into) = ends
            if first is None:
                yield Outside(str(output), self.path_here(f"{second}.{into}"))
            elif second is None:
                yield Outside(str(into), self.path_here(f"{first}.{output}"))
            else:
                yield Ends(
                    self.path_here(f"{first}.{output}"),
                    self.path_here(f"{second}.{into}"),
                    element.get(START_UNIT, ""),
                    element.get(END_UNIT, ""),
                )

    def ports(self, outside: Iterable[Outside]) -> dict[str, str]:
        """The system's ports; a note names its connectors that are none."""
        ports, others = ports_of(outside)
        if others:
            self.notes.append(f"{self.file}: connectors of no port are open: {', '.join(others)}")
        return ports

    def values(
        self,
        element: Element,
        where: str,
        variables: Mapping[str, PartVariable],
        units: ConnectorUnits,
        part: str = "",
    ) -> dict[str, float | str]:
        """Values of all bindings of an element; `part.` stands in front of a component's names."""
        found: dict[str, float | str] = {}
        for parameter, unit in parameters(element, where, self):
            name = parameter.get("name", "")
            where_here = f"{where}, parameter '{name}'"
            path = f"{part}{name}" if part else self.path_here(name)
            if unit is not None:
                units.check_value(path, unit, variables.get(path), where_here)
            found[path.removeprefix(part)] = value_of(parameter, where_here, self)
        return found

    def channels(self, system: Element) -> dict[str, tuple[str, ...]]:
        """Groups of result columns, which this package writes as an annotation."""
        return {
            check_name(channel.get("name", ""), f"{self.file}: channel"): tuple(
                channel.get("columns", "").split()
            )
            for annotation in system.iterfind("ssd:Annotations/ssc:Annotation", NAMESPACES)
            if annotation.get("type") == CHANNELS_ANNOTATION
            for channel in annotation.iterfind("hb:Channels/hb:Channel", NAMESPACES)
        }
