"""Archives from strangers: FMUs and SSPs are zip files."""

from collections.abc import Iterable
from pathlib import PurePosixPath


def escaping_entry(names: Iterable[str]) -> str | None:
    """The first entry of a zip file that would be written outside its folder, if any."""
    for name in names:
        path = PurePosixPath(name.replace("\\", "/"))
        if path.is_absolute() or ".." in path.parts or any(":" in part for part in path.parts):
            return name
    return None
