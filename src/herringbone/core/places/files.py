"""Questions about files whose names come from people and files."""

import contextlib
import os
from collections.abc import Mapping
from pathlib import Path


def is_file(path: Path) -> bool:
    """True for a file; False also for what no file can be called, such as too long a name."""
    return os.path.isfile(path)  # noqa: PTH113 (pathlib's raises for such names)


def is_folder(path: Path) -> bool:
    """True for a folder; False also for what no folder can be called."""
    return os.path.isdir(path)  # noqa: PTH112 (pathlib's raises for such names)


def beside(value: float | str, folder: Path) -> float | str:
    """A value from a file in a folder, or from a command that runs there.

    A text that is the relative name of a file there becomes its absolute path. Any other text stays
    as it is: a name in the resources of a component.
    """
    if not isinstance(value, str) or not value or Path(value).is_absolute():
        return value
    file = folder / value
    return str(file.absolute()) if is_file(file) else value


def as_texts(values: Mapping[str, float | str | Path] | None) -> dict[str, float | str]:
    """Values by name, with paths as text; empty for None."""
    return {k: str(v) if isinstance(v, Path) else v for k, v in (values or {}).items()}


def same_folder() -> contextlib.AbstractContextManager[None]:
    """Context after which the working folder is what it was, whatever FMUs did to it."""
    return contextlib.chdir(Path.cwd())
