"""Native FMUs that come with a released wheel, for those who have no compiler."""

from collections.abc import Iterable
from pathlib import Path

from herringbone.core import FmuError
from herringbone.core.places.paths import PACKAGE
from herringbone.core.reading.archives import open_archive
from herringbone.core.reading.xml import parse_xml
from herringbone.fmi.description.common import identifier
from herringbone.fmi.native.model import Model
from herringbone.fmi.native.platforms import Platform

IN_WHEEL = "herringbone/data/native_fmus"
"""Folder in the wheel."""
_FOLDER = PACKAGE.parent / IN_WHEEL
_DESCRIPTION, _LARGEST = "modelDescription.xml", 2**26
_TOKENS = {2: "guid", 3: "instantiationToken"}


def carried_name(name: str, fmi: int) -> str:
    """Path of a component's FMU in that folder."""
    return f"fmi{fmi}/{name}.fmu"


def carried_fmu(
    model: Model, platforms: Iterable[Platform], fmi: int, folder: Path = _FOLDER
) -> Path | None:
    """The FMU of a component that lies in the package; None if it has none of these sources.

    Args:
        model: what is asked for.
        platforms: all of which it must have binaries for.
        fmi: FMI version.
        folder: where carried FMUs lie.

    Raises:
        FmuError: the file is no FMU.
    """
    file = folder / carried_name(model.name, fmi)
    if not model.shipped or not file.is_file():
        return None
    with open_archive(file, "an FMU", FmuError) as archive:
        names = set(archive.names)
        root = parse_xml(archive.read(_DESCRIPTION, _LARGEST), f"{file}: {_DESCRIPTION}", FmuError)
    own = identifier(model.component, model.states.built_with)
    wanted = (_binary(model.name, p, fmi) for p in platforms)
    return file if root.get(_TOKENS[fmi]) == own and names.issuperset(wanted) else None


def _binary(name: str, platform: Platform, fmi: int) -> str:
    folder = platform.folder if fmi == 2 else platform.name
    return f"binaries/{folder}/{name}.{platform.extension}"
