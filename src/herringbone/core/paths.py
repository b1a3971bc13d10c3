"""Where things lie: component folders, system folders, generated artefacts."""

import hashlib
import os
from functools import cache
from pathlib import Path

from herringbone.core.errors import ResourceError

PACKAGE = Path(__file__).resolve().parents[1]
CACHE_VARIABLE = "HERRINGBONE_CACHE"
_COMPUTING = ("core", "kernels", "components", "cosim", "fmi")
"""Packages whose sources decide what is compiled and packed."""


def _clone() -> Path | None:
    root = PACKAGE.parents[1]
    return root if (root / "pyproject.toml").is_file() and (root / "fmus").is_dir() else None


def _data(folder: str) -> Path:
    clone = _clone()
    return (clone if clone else PACKAGE / "data") / folder


def component_folder(component: str) -> Path:
    """Folder of a component: script, README, resources."""
    return _data("fmus") / component


def systems_folder() -> Path:
    """Folder of the system models that come with the package."""
    return _data("system_models")


@cache
def content_hash() -> str:
    """Hash of the sources and resources that decide what is compiled and packed.

    Golden results are left out: they follow from the sources.
    """
    digest = hashlib.sha256()
    for root in (*(PACKAGE / name for name in _COMPUTING), _data("fmus")):
        for file in sorted(root.rglob("*")):
            source = file.suffix in {".py", ".csv", ".c", ".h"} and file.is_file()
            if source and file.name != "golden.csv":
                digest.update(file.relative_to(root).as_posix().encode())
                digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def cache_folder(kind: str) -> Path:
    """Folder for generated artefacts of these sources, made if needed.

    `build/` in a clone, the user's cache folder when installed; HERRINGBONE_CACHE overrides both.

    Raises:
        ResourceError: the folder cannot be made.
    """
    clone = _clone()
    if CACHE_VARIABLE in os.environ:
        root = Path(os.environ[CACHE_VARIABLE])
    elif clone:
        root = clone / "build"
    elif "LOCALAPPDATA" in os.environ:
        root = Path(os.environ["LOCALAPPDATA"]) / "herringbone"
    else:
        root = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "herringbone"
    folder = root / kind / content_hash()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ResourceError(
            f"cannot write to {folder} ({error.strerror}); "
            f"set {CACHE_VARIABLE} to a folder that can be written"
        ) from error
    return folder


# Taken now, before the modules that it covers are imported: sources that are edited later in this
# process must not get compiled code cached under their name.
content_hash()
