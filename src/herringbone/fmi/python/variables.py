"""Whether an FMU was built with the variables that the installed package has."""

from pathlib import Path
from xml.etree.ElementTree import Element

from herringbone.core import FmuError
from herringbone.core.reading.xml import parse_xml


def has_same_variables(folder: Path, description: Element) -> bool:
    """True if an unzipped FMU has the variables of a description; False if it cannot be read.

    Args:
        folder: of the FMU's modelDescription.xml.
        description: root element of what the package would write there.
    """
    file = folder / "modelDescription.xml"
    try:
        return _variables(parse_xml(file.read_bytes(), str(file), FmuError)) == _variables(
            description
        )
    except (OSError, FmuError):
        return False


def _variables(description: Element) -> list[tuple[str | None, ...]]:
    """Name, value reference, type and unit of each variable."""
    return [
        (v.get("name"), v.get("valueReference"), kind.tag, kind.get("unit"))
        for v in description.iter("ScalarVariable")
        for kind in v
    ]
