"""Nested systems of an SSP 1.0 file as one flat system, which the reader knows."""

from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from copy import deepcopy
from xml.etree.ElementTree import Element, SubElement

from herringbone.core import StructureError
from herringbone.core.names import is_identifier
from herringbone.cosim.ssp.format import (
    NAMESPACES,
    PARTS_ANNOTATION,
    SUPPRESS_CONVERSION,
    local_name,
    qualified,
    suppresses_conversion,
)
from herringbone.cosim.ssp.units import declared_unit

START_UNIT, END_UNIT = "hb:startUnit", "hb:endUnit"
"""Attributes of a connection: unit of the connector on the way that is nearest to this end."""
Refusal = Callable[[str], StructureError]
_SEPARATOR = "__"
_ENDS = ("start", "end")
_OUTSIDE = ""
"""What stands for the whole system, whose connectors lead outside."""


def flattened(system: Element, refusal: Refusal) -> tuple[Element, list[str]]:
    """The system with all components in it, the system itself if it contains no other; open inputs.

    Components are called `outer__inner`; an annotation says their paths. Connections are followed
    through the connectors of the systems between, whose units they keep. Inputs of these at which
    nothing arrives are open: what they lead to keeps its start values.

    Raises:
        StructureError: a nested system has values, a connector of it has two sources, or a
            connection leads to no component.
    """
    elements = system.find("ssd:Elements", NAMESPACES)
    if elements is None or not any(local_name(child) == "System" for child in elements):
        return system, []
    flat = Element(system.tag, dict(system.attrib))
    for child in system:
        if local_name(child) not in {"Elements", "Connections"}:
            flat.append(child)
    inside = SubElement(flat, qualified("ssd:Elements"))
    paths: dict[str, str] = {}
    for path, component in _components(system, "", refusal):
        inside.append(component)
        if path != component.get("name"):
            paths[component.get("name", "")] = path
    connections = SubElement(flat, qualified("ssd:Connections"))
    names, still = {c.get("name", "") for c in inside}, dict[str, None]()
    for connection in _connections(system, names, refusal, still):
        connections.append(connection)
    _annotate(flat, paths)
    return flat, list(still)


def _components(system: Element, path: str, refusal: Refusal) -> Iterator[tuple[str, Element]]:
    """Paths and elements of all components, which get flat names."""
    for child in system.iterfind("ssd:Elements/*", NAMESPACES):
        inner = f"{path}.{child.get('name', '')}" if path else child.get("name", "")
        if local_name(child) != "System":
            component = deepcopy(child)
            component.set("name", _flat(inner))
            yield inner, component
            continue
        if child.find("ssd:ParameterBindings", NAMESPACES) is not None:
            raise refusal(f"nested system '{inner}' has values; give them to its components")
        if child.find("ssd:SignalDictionaries", NAMESPACES) is not None:
            raise refusal(f"nested system '{inner}' has signal dictionaries; connect directly")
        yield from _components(child, inner, refusal)


def _links(system: Element, path: str) -> Iterator[Element]:
    """All connections, whose elements get flat names; a system's is that of its own."""
    for connection in system.iterfind("ssd:Connections/ssd:Connection", NAMESPACES):
        link = deepcopy(connection)
        for end in _ENDS:
            name = connection.get(f"{end}Element")
            inner = f"{path}.{name}" if path and name else name or path
            link.set(f"{end}Element", _flat(inner))
        yield link
    for child in system.iterfind("ssd:Elements/ssd:System", NAMESPACES):
        name = child.get("name", "")
        yield from _links(child, f"{path}.{name}" if path else name)


def _connections(
    system: Element, components: set[str], refusal: Refusal, still: dict[str, None]
) -> Iterator[Element]:
    """Connections of components and of the whole system, followed through connectors of others.

    What leads on from an input of a nested system at which nothing arrives is left out, and the
    input noted in `still`.
    """
    links, nested = list(_links(system, "")), dict(_nested(system, ""))
    connectors = {
        (name, connector.get("name", "")): connector
        for name, inner in nested.items()
        for connector in inner.iterfind("ssd:Connectors/ssd:Connector", NAMESPACES)
    }
    ends = {*components, _OUTSIDE}
    for link in links:
        if (element := link.get("startElement", "")) not in ends and element not in nested:
            raise _missing(element, link.get("startConnector"), refusal)
    arriving = _arriving(links, ends, nested, connectors, refusal)
    for link in links:
        if link.get("endElement") not in ends:
            continue
        chain = [link]
        while chain[-1].get("startElement") not in ends and len(chain) <= len(links):
            if (before := arriving.get(_start(chain[-1]))) is None:
                break
            chain.append(before)
        last = _start(chain[-1])
        if last[0] in ends:
            yield _joined(chain, connectors)
        elif last in arriving or last not in connectors or connectors[last].get("kind") == "output":
            raise refusal(
                f"connection '{link.get('endElement')}.{link.get('endConnector')}': no output of a "
                "component arrives there"
            )
        else:
            still[".".join(last)] = None


def _joined(chain: Sequence[Element], connectors: Mapping[tuple[str, str], Element]) -> Element:
    """Connections from an end back to what arrives there as one, with the units on the way."""
    link, *others = chain
    passed = [connectors[at] for each in chain[:-1] if (at := _start(each)) in connectors]
    between = [unit for connector in passed if (unit := declared_unit(connector))]
    for before in others:
        link.extend(child for child in before)
        if suppresses_conversion(before):
            link.set(SUPPRESS_CONVERSION, "true")
    for key in ("startElement", "startConnector"):
        link.set(key, chain[-1].get(key, ""))
    for end in _ENDS:
        if link.get(f"{end}Element") == _OUTSIDE:
            del link.attrib[f"{end}Element"]
    if between:
        link.set(START_UNIT, between[-1])
        link.set(END_UNIT, between[0])
    return link


def _start(link: Element) -> tuple[str, str]:
    """Element and connector at which a connection starts."""
    return link.get("startElement", ""), link.get("startConnector", "")


def _nested(system: Element, path: str) -> Iterator[tuple[str, Element]]:
    """All nested systems, with flat names."""
    for child in system.iterfind("ssd:Elements/ssd:System", NAMESPACES):
        inner = f"{path}.{child.get('name', '')}" if path else child.get("name", "")
        yield _flat(inner), child
        yield from _nested(child, inner)


def _arriving(
    links: Sequence[Element],
    ends: Container[str],
    nested: Container[str],
    connectors: Container[tuple[str, str]],
    refusal: Refusal,
) -> dict[tuple[str, str], Element]:
    """What arrives at each connector of a nested system; components are checked with their FMUs."""
    found: dict[tuple[str, str], Element] = {}
    used = {_start(link) for link in links}
    for link in links:
        element, connector = end = link.get("endElement", ""), link.get("endConnector", "")
        if element in ends:
            continue
        if element not in nested:
            raise _missing(element, connector, refusal)
        if end not in connectors and end not in used:
            raise refusal(f"nested system '{element}' has no connector '{connector}'; connect one")
        if (other := found.setdefault(end, link)) is not link:
            first, second = (f"'{'.'.join(_start(x))}'" for x in (other, link))
            raise refusal(
                f"connector '{element}.{connector}' has two sources: {first} and {second}"
            )
    return found


def _missing(element: str, connector: str | None, refusal: Refusal) -> StructureError:
    return refusal(f"connection '{element}.{connector}': there is no component '{element}'")


def _annotate(system: Element, paths: dict[str, str]) -> None:
    """Write the paths of components whose names are flat now, where they are identifiers."""
    known = {n: p for n, p in paths.items() if all(map(is_identifier, p.split(".")))}
    annotations = SubElement(system, qualified("ssd:Annotations"))
    annotation = SubElement(annotations, qualified("ssc:Annotation"), type=PARTS_ANNOTATION)
    parts = SubElement(annotation, qualified("hb:Parts"))
    for name, path in known.items():
        SubElement(parts, qualified("hb:Part"), name=name, path=path)


def flat_path(names: Sequence[str]) -> str:
    """Names of nested systems and a component as one."""
    return _SEPARATOR.join(names)


def _flat(path: str) -> str:
    return flat_path(path.split("."))
