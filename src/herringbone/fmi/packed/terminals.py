"""terminalsAndIcons.xml: the variables that belong to one flange or seat, as one terminal."""

from xml.etree.ElementTree import Element, SubElement

from herringbone.core import Declaration
from herringbone.core.declaring.roles import Port

_FILE_VERSION = "3.0"
"""FMI 2.0.4 takes the file of FMI 3.0."""
_HALF = 100.0
_HEIGHT = 10.0


def terminals_and_icons(declaration: Declaration) -> Element:
    """The root element: an icon, and a terminal for every port."""
    root = Element("fmiTerminalsAndIcons", fmiVersion=_FILE_VERSION)
    picture = SubElement(root, "GraphicalRepresentation")
    corners = {"x1": -_HALF, "y1": -_HALF, "x2": _HALF, "y2": _HALF}
    square = {name: repr(value) for name, value in corners.items()}
    SubElement(picture, "CoordinateSystem", {**square, "suggestedScalingFactorTo_mm": "0.1"})
    SubElement(picture, "Icon", square)
    if declaration.ports:
        terminals = SubElement(root, "Terminals")
        for port in declaration.ports:
            _add(terminals, declaration, port)
    return root


def _add(terminals: Element, declaration: Declaration, port: Port) -> None:
    members = [
        v
        for v in (*declaration.inputs, *declaration.outputs)
        if v.name.startswith(f"{port.name}.") and v.name not in declaration.hidden
    ]
    if not members:
        return
    terminal = SubElement(
        terminals, "Terminal", name=port.name, matchingRule="bus", terminalKind=port.kind.value
    )
    for v in members:
        SubElement(
            terminal,
            "TerminalMemberVariable",
            variableName=v.name,
            memberName=v.name.removeprefix(f"{port.name}."),
            variableKind="signal",
        )
