"""JSON files of our own that tell the number of their format."""

from pathlib import Path
from typing import Any

from herringbone.core import ResourceError
from herringbone.core.places.files import is_file
from herringbone.core.reading.structured import read_json


def read_formatted(file: Path, latest: int) -> dict[str, Any] | None:
    """Content of such a file; None if there is none.

    Args:
        file: the file; the number of its format is its `format`.
        latest: format that is known.

    Raises:
        ResourceError: it cannot be read, or is of a later format.
    """
    if not is_file(file):
        return None
    found = read_json(file)
    version = found.get("format", 0)
    if isinstance(version, int) and version > latest:
        raise ResourceError(
            f"{file}: its format is {version}, and this version of the package reads up to "
            f"{latest}; read it with a newer one"
        )
    return found
