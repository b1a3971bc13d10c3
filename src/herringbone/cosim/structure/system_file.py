"""Reading a system from `system.toml`.

name = "gearbox"
description = "..."

connections = [["gears.pinion_left", "bearings.shaft.pinion_left"], ...]
gear = "my_pair.toml"            # optional: of the gear pair; or { PATH = "FILE", ... } of several
housing = "my_housing"           # optional, likewise: folder of data, dimensions, or FMU

[parts.gears]
component = "NAME"               # or fmu = "file.fmu", or system = "name or folder"
set = { backlash = 1.8e-4 }

[ports]                          # offered to an outer system
pinion = "gears.pinion"

[channels]                       # result columns on which errors are measured
bearing_force = ["bearings.shaft.*.f_?"]

[sensors.A]                      # see `cosim.structure.sensors`
of = "housing.A.v_z"
"""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from herringbone.core import StructureError
from herringbone.core.names import check_name, identifier_for, meant, shown
from herringbone.core.places.files import beside, is_file
from herringbone.core.places.part_path import PartPath
from herringbone.core.places.paths import systems_folder
from herringbone.core.reading.structured import read_toml
from herringbone.cosim.structure.sensors import placed, read_sensors
from herringbone.cosim.structure.system import PartSpec, System

FILE_NAME = "system.toml"
_LONGEST_PATH = 300
_KEYS: dict[str, type] = {
    "name": str, "description": str, "connections": list, "parts": dict, "ports": dict,
    "channels": dict, "sensors": dict,
}  # fmt: skip
_TYPE_NAMES: dict[type, str] = {str: "a text", list: "a list", dict: "a table"}
_KINDS = ("component", "fmu", "system")
_FILES = ("gear", "housing")
_OF_GEARS = "gear_pair"
"""Section that every gear file has, see `gears.files.gear_file`."""


VALUE_HINT = 'it takes a number or a text; quote a name that has dots: "a.b" = 1.0'


def is_value(value: object, *, arrays: bool = False) -> bool:
    """True if a variable can be set to this value from TOML (Booleans: for foreign FMUs).

    Args:
        value: from TOML.
        arrays: lists may be among them, for arrays of foreign FMUs.
    """
    if arrays and isinstance(value, list):
        return all(is_value(item, arrays=True) for item in value)
    return isinstance(value, float | int | str)


def find_system(reference: str | Path, outer: Path | None = None) -> Path:
    """Folder of a system, by the name of a shipped one, by its path, or by that of its file.

    Args:
        reference: name or path; a Path, and what has a separator or is dots alone, is a path.
        outer: folder of the system that names it: paths start there, not in the working folder.

    Raises:
        StructureError: there is no such system, or it is a gear file.
    """
    path = Path(reference)
    own = path.parent if path.name == FILE_NAME else path
    shipped = systems_folder() / reference
    first = (outer or Path()) / own
    for folder in (first, shipped) if outer or _is_path(reference) else (shipped, own):
        if is_file(folder / FILE_NAME):
            return folder
    _refuse_gear_file((outer or Path()) / path)
    known = sorted(f.parent.name for f in systems_folder().glob(f"*/{FILE_NAME}"))
    named_in = f"{outer / FILE_NAME}: " if outer else ""
    raise StructureError(
        f"{named_in}there is no system {shown(str(reference), _LONGEST_PATH)}: "
        f"{meant(str(reference), known)}give one of {', '.join(known)}, "
        f"a folder with {FILE_NAME}, or an .ssp file"
    )


def _refuse_gear_file(file: Path) -> None:
    """Raises StructureError if it is one; what cannot be read is none."""
    try:
        content = read_toml(file, StructureError) if is_file(file) else {}
    except StructureError:
        return
    if _OF_GEARS in content:
        raise StructureError(f"{file} is a gear file: herringbone run SYSTEM --gear {file}")


def _is_path(reference: str | Path) -> bool:
    """True for what can be no name, as `./gearbox`, which Path makes `gearbox` of."""
    separators = {os.sep, os.altsep or os.sep, "/"}
    dots = reference in {os.curdir, os.pardir}
    return isinstance(reference, Path) or dots or any(s in reference for s in separators)


def shipped_before_own(reference: str | Path) -> bool:
    """True if a name is that of a shipped system, which is taken, and of a folder that is here."""
    if _is_path(reference):
        return False
    return all(is_file(place / reference / FILE_NAME) for place in (systems_folder(), Path()))


def short_name(reference: str | Path) -> str:
    """What files of a system are called: the name of its folder, or of its .ssp file."""
    path = Path(reference)
    return path.absolute().parent.name if path.name == FILE_NAME else path.stem


def read_system(reference: str | Path, _outer: tuple[Path, ...] = ()) -> System:
    """Read a system and everything nested in it.

    Raises:
        StructureError: not found, not readable, unknown key, or systems that contain each other.
    """
    folder = find_system(reference, *_outer[-1:]).resolve()
    if folder in _outer:
        raise StructureError(f"system '{reference}' contains itself")
    file = folder / FILE_NAME
    data = read_toml(file, StructureError)
    unknown = set(data) - {*_KEYS, *_FILES}
    if unknown:
        known = (*_KEYS, *_FILES)
        hint = meant(min(unknown), known)
        raise StructureError(
            f"{file}: unknown key {', '.join(sorted(unknown))}; {hint}known: {', '.join(known)}"
        )
    for key, kind in _KEYS.items():
        _check_type(data.get(key, kind()), kind, key, file)
    _check_names(data, file)
    for name, path in data.get("ports", {}).items():
        _check_type(path, str, f"port '{name}'", file)
    for name, patterns in data.get("channels", {}).items():
        _check_type(patterns, list, f"channel '{name}'", file)
        for pattern in patterns:
            _check_type(pattern, str, f"channel '{name}': pattern", file)
    parts: list[PartSpec] = []
    nested: dict[str, System] = {}
    for name, table in data.get("parts", {}).items():
        spec = _part(name, table, folder, file)
        if spec:
            parts.append(spec)
        else:
            inner = read_system(table["system"], (*_outer, folder))
            nested[name] = inner.with_values(_set(table, folder)).nested_as(name)
    if not parts and not nested:
        raise StructureError(f"{file}: it has no parts; 'herringbone template system' shows some")
    return _assemble(data, file, parts, nested)


def _check_names(data: Mapping[str, Any], file: Path) -> None:
    for name in (data["name"],) if "name" in data else ():
        check_name(name, f"{file}: name")
    for key in ("parts", "ports", "channels", "sensors"):
        for name in data.get(key, {}):
            check_name(name, f"{file}: {key.removesuffix('s')}")


def _check_type(value: object, kind: type, what: str, file: Path) -> None:
    if not isinstance(value, kind):
        raise StructureError(f"{file}: {what} = {value!r}: it takes {_TYPE_NAMES[kind]}")


def _part(name: str, table: Mapping[str, Any], folder: Path, file: Path) -> PartSpec | None:
    _check_type(table, dict, f"part '{name}'", file)
    kinds = [kind for kind in _KINDS if kind in table]
    unknown = set(table) - {*_KINDS, "set"}
    if len(kinds) != 1 or unknown:
        raise StructureError(
            f"{file}, part '{name}': give exactly one of {', '.join(_KINDS)}, and 'set'"
            + (f"; unknown: {', '.join(sorted(unknown))}" if unknown else "")
        )
    _check_type(table[kinds[0]], str, f"part '{name}': {kinds[0]}", file)
    if not table[kinds[0]].isprintable():
        raise StructureError(
            f"{file}: part '{name}': {shown(table[kinds[0]])} is no name of a file"
        )
    values = table.get("set", {})
    _check_type(values, dict, f"part '{name}': set", file)
    for variable, value in values.items():
        if not is_value(value, arrays=kinds[0] == "fmu"):
            raise StructureError(f"{file}: {name}.{variable} = {value!r}: {VALUE_HINT}")
    values = _set(table, folder)
    if kinds[0] == "system":
        return None
    if kinds[0] == "fmu":
        return PartSpec(PartPath(name), fmu=(folder / table["fmu"]).resolve(), values=values)
    return PartSpec(PartPath(name), component=table["component"], values=values)


def _set(table: Mapping[str, Any], folder: Path) -> dict[str, float | str]:
    """Values that a part is given; files beside this one by their whole names."""
    return {name: beside(value, folder) for name, value in table.get("set", {}).items()}


def part_files(data: Mapping[str, Any], key: str, file: Path) -> dict[str, Path]:
    """Files of a key, by path of the part: one text, for the only such part, or a table of them.

    Raises:
        StructureError: it is neither.
    """
    given = data.get(key, {})
    found = given if isinstance(given, dict) else {"": given}
    for path, name in found.items():
        _check_type(name, str, f"{key} of {path}" if path else key, file)
    return {path: (file.parent / name).absolute() for path, name in found.items()}


def _assemble(
    data: Mapping[str, Any], file: Path, parts: list[PartSpec], nested: Mapping[str, System]
) -> System:
    """One flat system; paths through a nested system's ports become paths of its parts."""

    def resolve(path: str) -> str:
        name, _, port = path.partition(".")
        if name not in nested:
            return path
        head, _, rest = port.partition(".")
        if head not in nested[name].ports:
            known = ", ".join(nested[name].ports)
            raise StructureError(f"{file}: '{path}': '{name}' offers the ports {known}")
        return nested[name].ports[head] + (f".{rest}" if rest else "")

    channels: dict[str, tuple[str, ...]] = {}
    connections: list[tuple[str, str]] = []
    for inner in nested.values():
        parts += inner.parts
        connections += inner.connections
        for name, patterns in inner.channels.items():
            channels[name] = (*channels.get(name, ()), *patterns)
    for pair in data.get("connections", []):
        texts = isinstance(pair, list) and all(isinstance(path, str) for path in pair)
        if not texts or len(pair) != 2:
            raise StructureError(f"{file}: a connection is a pair of paths, not {pair!r}")
        connections.append((resolve(pair[0]), resolve(pair[1])))
    channels |= {name: tuple(p) for name, p in data.get("channels", {}).items()}
    gears, housings = (
        {p: f for inner in nested.values() for p, f in getattr(inner, f"{key}s").items()}
        | part_files(data, key, file)
        for key in _FILES
    )
    own_name = data.get("name", file.parent.name)
    name = identifier_for(own_name)
    renamed = (f"{file}: the system is called {name} here",) if name != own_name else ()
    sensors = {k: v for inner in nested.values() for k, v in inner.sensors.items()}
    sensors |= read_sensors(data.get("sensors", {}), file)
    inner_notes = tuple(note for inner in nested.values() for note in inner.notes)
    return System(
        name,
        data.get("description", ""),
        tuple(parts),
        tuple(connections),
        {name: resolve(path) for name, path in data.get("ports", {}).items()},
        channels,
        (*inner_notes, *renamed),
        gears,
        housings,
        placed(sensors, [part.name for part in parts], str(file)),
    )
