"""FMU files that depend on their content alone."""

import zipfile
from collections.abc import Mapping
from pathlib import Path

_TIMESTAMP = (1980, 1, 1, 0, 0, 0)
_PERMISSIONS = 0o644 << 16


def write_archive(target: Path, content: Mapping[str, bytes]) -> None:
    """Write a zip file with sorted names, one timestamp and compression."""
    with zipfile.ZipFile(target, "w") as archive:
        for name in sorted(content):
            entry = zipfile.ZipInfo(name, _TIMESTAMP)
            entry.create_system = 3
            entry.external_attr = _PERMISSIONS
            archive.writestr(entry, content[name], zipfile.ZIP_DEFLATED, compresslevel=9)


def add_to_archive(target: Path, content: Mapping[str, bytes]) -> None:
    """Write a zip file anew with further entries."""
    with zipfile.ZipFile(target) as archive:
        before = {name: archive.read(name) for name in archive.namelist()}
    write_archive(target, {**before, **content})
