"""Packing a native FMU: description, binaries, resources, documentation."""

import struct
from collections.abc import Mapping
from pathlib import Path
from xml.etree.ElementTree import Element, indent, tostring

from herringbone.core import Component
from herringbone.fmi.archive import write_archive
from herringbone.fmi.description.fmi2 import model_description
from herringbone.fmi.description.fmi3 import model_description_3
from herringbone.fmi.native.model import Model
from herringbone.fmi.native.platforms import Platform
from herringbone.fmi.packed.documentation import (
    communication_steps,
    documentation,
    licence,
)
from herringbone.fmi.packed.icon import icon
from herringbone.fmi.packed.terminals import terminals_and_icons

_FAT_MAGIC, _FAT_ALIGNMENT = 0xCAFEBABE, 14
_FAT_CPUS = {"x86_64-darwin": (0x01000007, 3), "aarch64-darwin": (0x0100000C, 0)}


def pack_native(model: Model, libraries: Mapping[Platform, Path], fmi: int, fmu: Path) -> Path:
    """Pack a model as FMU; two packs of the same binaries are identical.

    Args:
        model: what is packed.
        libraries: its libraries by platform.
        fmi: FMI version, 2 or 3.
        fmu: file that is written.
    """
    component = model.component
    description = (
        model_description(component, model.states)
        if fmi == 2
        else model_description_3(model.states)
    )
    binaries = _by_tuple(component, libraries) if fmi == 3 else _by_system(component, libraries)
    resources = {f"resources/{name}": file.read_bytes() for name, file in model.resources.items()}
    content = {
        "modelDescription.xml": _xml(description),
        "documentation/index.html": documentation(component, libraries),
        "documentation/licenses/license.txt": licence(),
        "model.png": icon(),
        "terminalsAndIcons/icon.png": icon(),
        "terminalsAndIcons/terminalsAndIcons.xml": _xml(terminals_and_icons(component.declaration)),
        **binaries,
        **resources,
        **communication_steps(component),
    }
    write_archive(fmu, content)
    return fmu


def _xml(root: Element) -> bytes:
    indent(root)
    return tostring(root, encoding="utf-8", xml_declaration=True)


def _by_tuple(component: Component, libraries: Mapping[Platform, Path]) -> dict[str, bytes]:
    return {
        f"binaries/{platform.name}/{component.name}.{platform.extension}": file.read_bytes()
        for platform, file in libraries.items()
    }


def _by_system(component: Component, libraries: Mapping[Platform, Path]) -> dict[str, bytes]:
    """FMI 2.0 has one folder for both architectures of macOS: they share a universal file."""
    grouped: dict[str, dict[Platform, bytes]] = {}
    for platform, file in libraries.items():
        name = f"binaries/{platform.folder}/{component.name}.{platform.extension}"
        grouped.setdefault(name, {})[platform] = file.read_bytes()
    return {
        name: _universal(files) if len(files) > 1 else next(iter(files.values()))
        for name, files in grouped.items()
    }


def _universal(libraries: Mapping[Platform, bytes]) -> bytes:
    """A macOS universal file (mach-o/fat.h): a table, then the libraries, aligned."""
    table = struct.pack(">II", _FAT_MAGIC, len(libraries))
    align = 1 << _FAT_ALIGNMENT
    body, at = b"", align
    for platform, data in libraries.items():
        cpu, subtype = _FAT_CPUS[platform.name]
        table += struct.pack(">IIIII", cpu, subtype, at, len(data), _FAT_ALIGNMENT)
        padded = data + b"\0" * (-len(data) % align)
        body, at = body + padded, at + len(padded)
    return table + b"\0" * (align - len(table)) + body
