"""The system structure description of an SSP 1.0 file, as an XML tree."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement

from herringbone.core import StructureError
from herringbone.core.part import PartVariable
from herringbone.cosim.layouts.layout import record_names
from herringbone.cosim.ssp.annotations import add_experiment, add_system_annotations, add_units
from herringbone.cosim.ssp.boxes import Box, Corners, boxes, coordinates
from herringbone.cosim.ssp.described import DescribedPart
from herringbone.cosim.ssp.format import (
    FMU_TYPE,
    NAMESPACES,
    PARAMETER_TYPE,
    VERSION,
)
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.system import System

_CONNECTORS = {
    "Real": "Real",
    "Float64": "Real",
    "Integer": "Integer",
    "Boolean": "Boolean",
    "String": "String",
}
"""SSP types of connectors by FMI type."""
_ENDS = ("startElement", "startConnector", "endElement", "endConnector")


def xml_root(tag: str, prefixes: Iterable[str], **attributes: str) -> Element:
    """Root element of an SSP file, which declares all prefixes."""
    declared = {f"xmlns:{prefix}": NAMESPACES[prefix] for prefix in prefixes}
    return Element(tag, {**declared, "version": VERSION, **attributes})


def structure(
    system: System,
    parts: Sequence[DescribedPart],
    network: Network,
    sources: Mapping[Path, str],
    step: float,
    t_end: float,
    *,
    nested: bool = False,
) -> Element:
    """The whole system structure description.

    Args:
        system: structure.
        parts: its parts, in the same order.
        network: its connections, resolved.
        sources: place of each FMU file in the .ssp.
        step: communication step size [s].
        t_end: stop time of the default experiment [s].
        nested: nested systems are systems of their own, with connectors; so are the ports of the
            whole.

    Raises:
        StructureError: a unit name has two meanings.
    """
    root = xml_root(
        "ssd:SystemStructureDescription", NAMESPACES, name=system.name, generationTool="herringbone"
    )
    connectors = _connectors(network)
    tree = boxes(parts, network, system.ports if nested else {}, nested=nested)
    for p, variable in tree[""].connectors.values():
        if variable.name not in connectors[p]:
            connectors[p].append(variable.name)
    inner = SubElement(root, "ssd:System", name=system.name, description=system.description)
    _fill_system(inner, tree, tree[""], parts, connectors, sources)
    add_system_annotations(inner, system, step, flat=not nested)
    add_units(root, parts, connectors)
    add_experiment(root, step, t_end)
    return root


def _fill_system(
    system: Element,
    tree: Mapping[str, Box],
    box: Box,
    parts: Sequence[DescribedPart],
    connectors: Sequence[Sequence[str]],
    sources: Mapping[Path, str],
) -> None:
    """Write what a system contains, in the order that the format asks for."""
    _add_connectors(system, [(n, parts[p], v) for n, (p, v) in box.connectors.items()])
    if box.corners:
        SubElement(system, "ssd:ElementGeometry", coordinates(box.corners))
    elements = SubElement(system, "ssd:Elements")
    for p, name in box.parts.items():
        source = sources[parts[p].file]
        _add_component(elements, parts[p], name, connectors[p], source, box.places[name])
    for scope, name in box.systems.items():
        inner = SubElement(elements, "ssd:System", name=name)
        _fill_system(inner, tree, tree[scope], parts, connectors, sources)
    if box.wires:
        connections = SubElement(system, "ssd:Connections")
        for wire in box.wires:
            ends = zip(_ENDS, wire, strict=True)
            SubElement(connections, "ssd:Connection", {key: name for key, name in ends if name})


def _connectors(network: Network) -> list[list[str]]:
    """Names of each part's connectors: connected inputs, recorded and connected outputs."""
    found = []
    for i, recorded in enumerate(record_names(network)):
        scalars = [n for n in recorded if not network.parts[i].variables[n].array]
        inputs = [c.input for c in network.every_connection if c.target == i]
        outputs = [c.output for c in network.every_connection if c.source == i]
        found.append(list(dict.fromkeys([*inputs, *scalars, *outputs])))
    return found


def _add_component(
    elements: Element,
    part: DescribedPart,
    name: str,
    connectors: Sequence[str],
    source: str,
    corners: Corners,
) -> None:
    component = SubElement(elements, "ssd:Component", name=name, type=FMU_TYPE, source=source)
    _add_connectors(component, [(c, part, part.variables[c]) for c in connectors])
    SubElement(component, "ssd:ElementGeometry", coordinates(corners))
    if part.values:
        bindings = SubElement(component, "ssd:ParameterBindings")
        SubElement(bindings, "ssd:ParameterBinding", type=PARAMETER_TYPE, source=part.values_file)


def _add_connectors(
    element: Element, found: Sequence[tuple[str, DescribedPart, PartVariable]]
) -> None:
    """Connectors by name, of what variable of which part; inputs at the left, outputs right."""
    if not found:
        return
    connectors = SubElement(element, "ssd:Connectors")
    kinds = [variable.causality for _, _, variable in found]
    count = {kind: kinds.count(kind) for kind in kinds}
    seen = dict.fromkeys(count, 0)
    for name, part, variable in found:
        kind = variable.causality
        connector = SubElement(connectors, "ssd:Connector", name=name, kind=kind)
        defined = variable.unit if variable.dimension else None
        SubElement(connector, _connector_type(part, variable), {"unit": defined} if defined else {})
        seen[kind] += 1
        x, y = float(kind == "output"), 1.0 - seen[kind] / (count[kind] + 1)
        SubElement(connector, "ssd:ConnectorGeometry", x=f"{x:g}", y=f"{y:.4g}")


def _connector_type(part: DescribedPart, variable: PartVariable) -> str:
    """Type of a connector in SSP 1.0; raises StructureError if it has none."""
    if variable.type not in _CONNECTORS or variable.array:
        what = "arrays" if variable.array else f"connectors of type {variable.type} here"
        raise StructureError(
            f"{part.name}.{variable.name}: SSP 1.0 has no {what}; disconnect it, or run the system "
            "without exporting it"
        )
    return f"ssc:{_CONNECTORS[variable.type]}"
