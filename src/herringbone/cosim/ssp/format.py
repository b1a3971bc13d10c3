"""What writing and reading SSP 1.0 files share: names of the format, and opening a file safely."""

import atexit
import shutil
import tempfile
import zipfile
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element, ParseError, fromstring
from xml.parsers import expat

from herringbone.core import StructureError
from herringbone.core.files import is_file, is_folder
from herringbone.cosim.fmu.archive import escaping_entry

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


def is_ssp(path: Path) -> bool:
    """True if a path names an .ssp file, or a folder into which one was unpacked."""
    return path.suffix == ".ssp" or is_file(path / STRUCTURE_FILE)


def unpack(file: Path) -> Path:
    """Folder with the content of an .ssp file, removed when the process ends.

    Args:
        file: an .ssp file; a folder is taken as it is.

    Raises:
        StructureError: no file, no zip, or an entry that would be written outside the folder.
    """
    if is_folder(file):
        return file
    with _archive(file) as archive:
        folder = Path(tempfile.mkdtemp(prefix="herringbone_ssp_"))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        archive.extractall(folder)
    return folder


def read_structure(file: Path) -> Element:
    """Root of the system structure of an .ssp file or unpacked folder.

    Raises:
        StructureError: it cannot be read, or is no system structure description of SSP 1.
    """
    try:
        if is_folder(file):
            data = (file / STRUCTURE_FILE).read_bytes()
        else:
            with _archive(file) as archive:
                data = archive.read(STRUCTURE_FILE)
    except (OSError, KeyError):
        raise StructureError(f"{file}: it contains no {STRUCTURE_FILE}") from None
    root = parse_xml(data, f"{file}: {STRUCTURE_FILE}")
    if root.tag != qualified("ssd:SystemStructureDescription"):
        raise StructureError(f"{file}: {STRUCTURE_FILE} is no SSP 1.0 system structure description")
    version = root.get("version", "")
    if not version.startswith("1."):
        raise StructureError(f"{file}: SSP version '{version}'; version 1.0 is needed")
    return root


def _archive(file: Path) -> zipfile.ZipFile:
    if not is_file(file):
        raise StructureError(f"there is no file {file}")
    try:
        archive = zipfile.ZipFile(file)
    except zipfile.BadZipFile as error:
        raise StructureError(f"{file} is not an .ssp file: {error}") from error
    if name := escaping_entry(archive.namelist()):
        archive.close()
        raise StructureError(f"{file}: entry '{name}' would be written outside its folder; refused")
    return archive


def parse_xml(data: bytes, where: str) -> Element:
    """Root of an XML text, in any encoding, without document type and entities.

    Args:
        data: the text.
        where: file, for messages.

    Raises:
        StructureError: it is malformed, or declares a DOCTYPE.
    """

    def refuse(*_: object) -> None:
        raise StructureError(f"{where} declares a DOCTYPE or an entity; refused")

    checker = expat.ParserCreate()
    checker.StartDoctypeDeclHandler = refuse
    try:
        checker.Parse(data, True)
        return fromstring(data)
    except (expat.ExpatError, ParseError, LookupError, ValueError) as error:
        raise StructureError(f"{where} is not well-formed: {error}") from error


def qualified(tag: str) -> str:
    """`prefix:name` in the notation of ElementTree."""
    prefix, _, name = tag.partition(":")
    return f"{{{NAMESPACES[prefix]}}}{name}"


def local_name(element: Element) -> str:
    """Name of an element without its namespace."""
    return element.tag.rpartition("}")[2]
