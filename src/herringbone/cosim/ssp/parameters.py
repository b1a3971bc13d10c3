"""Parameter sets of an .ssp file: values of a system or a component."""

from collections.abc import Callable, Iterator, Mapping
from xml.etree.ElementTree import Element

from herringbone.core import StructureError
from herringbone.core.reading.numbers import number, whole
from herringbone.core.reading.texts import read_bytes
from herringbone.core.reading.xml import LARGEST_XML, parse_xml
from herringbone.cosim.ssp.content import Content
from herringbone.cosim.ssp.format import NAMESPACES, PARAMETER_TYPE, local_name, qualified
from herringbone.cosim.ssp.units import Unit, definitions

_BOOLEANS = {"true": 1, "1": 1, "false": 0, "0": 0}
"""Words of xs:boolean."""


def _boolean(text: str) -> int:
    if (word := text.strip()) not in _BOOLEANS:
        raise ValueError(text)
    return _BOOLEANS[word]


def _item(text: str) -> int | str:
    """Number of an item, or its name."""
    try:
        return whole(text)
    except ValueError:
        return text


_TYPES: Mapping[str, Callable[[str], float | str]] = {
    "Real": number,
    "Integer": whole,
    "Boolean": _boolean,
    "String": str,
    "Enumeration": _item,
    "Binary": str,
    "Float64": number,
    "Float32": number,
    **{f"{kind}{n}": whole for kind in ("Int", "UInt") for n in (8, 16, 32, 64)},
}
"""Values of SSP 1.0, and those that 2.0 has besides."""


def parameters(
    element: Element, where: str, content: Content
) -> Iterator[tuple[Element, Unit | None]]:
    """Parameters of all bindings of an element, and the units of their values; later ones win.

    Args:
        element: a system or a component.
        where: it stands, for messages.
        content: of the file.

    Raises:
        StructureError: a binding uses what this master does not know, or a unit is no number.
    """
    for binding in element.iterfind("ssd:ParameterBindings/ssd:ParameterBinding", NAMESPACES):
        found = _parameter_set(binding, where, content)
        defined = definitions(found, "ssv:Units", content)
        for parameter in found.iterfind("ssv:Parameters/ssv:Parameter", NAMESPACES):
            unit = "" if (typed := _typed(parameter)) is None else typed.get("unit")
            yield parameter, Unit(unit, defined.get(unit)) if unit else None


def _parameter_set(binding: Element, where: str, content: Content) -> Element:
    if binding.find("ssd:ParameterMapping", NAMESPACES) is not None:
        raise content.refusal(f"{where}: parameter mappings (.ssm) are not supported")
    if binding.get("prefix"):
        raise content.refusal(f"{where}: prefixes of parameter bindings are not supported")
    if (found := binding.get("type", PARAMETER_TYPE)) != PARAMETER_TYPE:
        raise content.refusal(f"{where}: parameter source of type {found} is not supported")
    if binding.get("sourceBase", "SSD") != "SSD":
        raise content.refusal(f"{where}: parameter sources inside an FMU are not supported")
    source = binding.get("source")
    inline = binding.find("ssd:ParameterValues/ssv:ParameterSet", NAMESPACES)
    if source is None and inline is not None:
        return inline
    file = content.path(source or "", where)
    data = read_bytes(file, LARGEST_XML, StructureError)
    root = parse_xml(data, f"{content.file}: {source}", StructureError)
    if root.tag != qualified("ssv:ParameterSet"):
        raise content.refusal(f"{where}: {source} is no SSP 1.0 parameter set")
    return root


def value_of(parameter: Element, where: str, content: Content) -> float | str:
    """Value of a parameter.

    Args:
        parameter: see `parameters`.
        where: it stands, for messages.
        content: of the file.

    Raises:
        StructureError: of another type.
    """
    typed = _typed(parameter)
    kind = "nothing" if typed is None else local_name(typed)
    if typed is None or kind not in _TYPES:
        raise content.refusal(f"{where}: a value of type {kind} is not supported")
    text = typed.get("value", "")
    try:
        return _TYPES[kind](text)
    except ValueError:
        raise content.refusal(f"{where}: '{text}' is no {kind}") from None


def _typed(parameter: Element) -> Element | None:
    """What has the value."""
    return next((c for c in parameter if local_name(c) != "Annotations"), None)
