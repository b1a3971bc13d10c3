"""Modal data of housings."""

import json
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

from support.housing import small_housing

from fuzz.kinds.kind import Kind, file_of, zipped
from herringbone.housing import read_housing, write_housing
from herringbone.housing.files.file_format import HEAD, digest


def _with_hashes(name: str, entries: dict[str, bytes]) -> Callable[[bytes, Path], object]:
    """Reads a housing with another content of one file, and its hash."""

    def put(content: bytes, folder: Path) -> object:
        for other, text in {**entries, name: content}.items():
            (folder / other).write_bytes(text)
        if name != HEAD:
            head = json.loads(entries[HEAD])
            head["sha256"][name] = digest(content)
            (folder / HEAD).write_text(json.dumps(head))
        return read_housing(folder)

    return put


def housing_kinds() -> list[Kind]:
    with tempfile.TemporaryDirectory() as folder:
        write_housing(small_housing(modes=4), Path(folder) / "x")
        written = sorted((Path(folder) / "x").iterdir())
        entries = {file.name: file.read_bytes() for file in written}
    whole = Kind(
        "housing_archive", zipped(entries, zipfile.ZIP_DEFLATED), file_of("x.zip", read_housing)
    )
    return [
        whole, *(Kind(f"housing_{n}", c, _with_hashes(n, entries), 2) for n, c in entries.items()),
    ]  # fmt: skip
