"""What writing and reading SSP 1.0 files share: names of the format, and opening a file safely."""

import atexit
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element

from herringbone.core import StructureError
from herringbone.core.caching.remembered import Remembered, content_key
from herringbone.core.places.files import is_file, is_folder
from herringbone.core.places.temporary import filled_folder, remove_temporary_folder
from herringbone.core.reading.archives import open_archive
from herringbone.core.reading.texts import read_bytes
from herringbone.core.reading.xml import LARGEST_XML, parse_xml

STRUCTURE_FILE: Final = "SystemStructure.ssd"
VERSION: Final = "1.0"
FMU_TYPE: Final = "application/x-fmu-sharedlibrary"
PARAMETER_TYPE: Final = "application/x-ssp-parameter-set"
NAMESPACES: Final = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
    "osp": "http://opensimulationplatform.com/SSP/OSPAnnotations",
    "oms": "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd",
    "hb": "urn:herringbone:ssp",
}
CHANNELS_ANNOTATION: Final = "herringbone.channels"
PARTS_ANNOTATION: Final = "herringbone.parts"
"""Paths of parts whose names are flat in the file, by these names."""
SUPPRESS_CONVERSION: Final = "suppressUnitConversion"
_unpacked: Remembered[Path] = Remembered(256)
"""By content; a folder holds a descriptor."""


def is_ssp(path: Path) -> bool:
    """True if a path names an .ssp file, or a folder into which one was unpacked."""
    return path.suffix == ".ssp" or is_file(path / STRUCTURE_FILE)


def unpack(file: Path) -> Path:
    """Folder with the content of an .ssp file, which is not changed; removed when the process ends.

    A content that was unpacked before has its folder already.

    Args:
        file: an .ssp file; a folder is taken as it is.

    Raises:
        StructureError: no file, no zip, or an entry that would be written outside the folder.
    """
    if is_folder(file):
        return file
    return _unpacked(content_key(file), lambda: _unpack(file))


def _unpack(file: Path) -> Path:
    with open_archive(file, "an .ssp file", StructureError) as archive, filled_folder() as folder:
        archive.extract(folder)
    atexit.register(remove_temporary_folder, folder)
    return folder


def read_structure(file: Path) -> Element:
    """Root of the system structure of an .ssp file or unpacked folder.

    Raises:
        StructureError: it cannot be read, or is no system structure description of SSP 1.
    """
    if is_folder(file):
        data = read_bytes(file / STRUCTURE_FILE, LARGEST_XML, StructureError)
    else:
        with open_archive(file, "an .ssp file", StructureError) as archive:
            data = archive.read(STRUCTURE_FILE, LARGEST_XML)
    root = parse_xml(data, f"{file}: {STRUCTURE_FILE}", StructureError)
    if root.tag != qualified("ssd:SystemStructureDescription"):
        raise StructureError(f"{file}: {STRUCTURE_FILE} is no SSP 1.0 system structure description")
    version = root.get("version", "")
    if not version.startswith("1."):
        raise StructureError(f"{file}: SSP version '{version}'; version 1.0 is needed")
    return root


def qualified(tag: str) -> str:
    """`prefix:name` in the notation of ElementTree."""
    prefix, _, name = tag.partition(":")
    return f"{{{NAMESPACES[prefix]}}}{name}"


def local_name(element: Element) -> str:
    """Name of an element without its namespace."""
    return element.tag.rpartition("}")[2]


def suppresses_conversion(connection: Element) -> bool:
    """True if a connection asks that units are not converted."""
    return connection.get(SUPPRESS_CONVERSION, "false").strip() not in {"false", "0"}
