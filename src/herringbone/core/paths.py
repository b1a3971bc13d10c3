"""Where things lie: component folders, system folders, generated artefacts."""

import os
from pathlib import Path

from herringbone.core.errors import ResourceError

PACKAGE = Path(__file__).resolve().parents[1]
CACHE_VARIABLE = "HERRINGBONE_CACHE"


def _clone() -> Path | None:
    root = PACKAGE.parents[1]
    return root if (root / "pyproject.toml").is_file() and (root / "fmus").is_dir() else None


def _data(folder: str) -> Path:
    clone = _clone()
    return (clone if clone else PACKAGE / "data") / folder


def components_folder() -> Path:
    """Folder of the components' own folders."""
    return _data("fmus")


def component_folder(component: str) -> Path:
    """Folder of a component: script, README, resources."""
    return components_folder() / component


def systems_folder() -> Path:
    """Folder of the system models that come with the package."""
    return _data("system_models")


def cache_root() -> Path:
    """Folder of everything that is generated: `build/` in a clone, else the user's cache folder.

    HERRINGBONE_CACHE overrides both.
    """
    clone = _clone()
    if CACHE_VARIABLE in os.environ:
        return Path(os.environ[CACHE_VARIABLE])
    if clone:
        return clone / "build"
    if "LOCALAPPDATA" in os.environ:
        return Path(os.environ["LOCALAPPDATA"]) / "herringbone"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "herringbone"


def cache_folder(kind: str) -> Path:
    """Folder for generated artefacts of a kind, made if needed; see `core.caching.keys`.

    Raises:
        ResourceError: the folder cannot be made.
    """
    folder = cache_root() / kind
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ResourceError(
            f"cannot write to {folder} ({error.strerror}); "
            f"set {CACHE_VARIABLE} to a folder that can be written"
        ) from error
    return folder
