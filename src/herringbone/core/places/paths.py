"""Where things lie: component folders, system folders, generated artefacts."""

import os
import stat
import sys
from functools import cache
from pathlib import Path

from herringbone.core.errors import ResourceError

PACKAGE = Path(__file__).resolve().parents[2]
CACHE_VARIABLE = "HERRINGBONE_CACHE"


@cache
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


def module_path() -> str:
    """PYTHONPATH with which another process finds the modules of this one.

    Folders that are gone are left out: pythonfmu adds one an instance, and a variable has an end.
    """
    known = dict.fromkeys(os.path.abspath(path) for path in sys.path)  # noqa: PTH100 (as given)
    return os.pathsep.join(filter(os.path.exists, known))


def cache_root() -> Path:
    """Folder of everything that is generated: `build/` in a clone, else the user's cache folder.

    HERRINGBONE_CACHE overrides both, unless it is empty.
    """
    clone = _clone()
    if named := os.environ.get(CACHE_VARIABLE):
        return Path(named)
    if clone:
        return clone / "build"
    if "LOCALAPPDATA" in os.environ:
        return Path(os.environ["LOCALAPPDATA"]) / "herringbone"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "herringbone"


def cache_folder(kind: str) -> Path:
    """Folder for generated artefacts of a kind, made if needed; see `core.caching.keys`.

    Raises:
        ResourceError: the folder cannot be made, or others can change what is in it.
    """
    root = cache_root()
    folder = root / kind
    try:
        make_private(folder)
        unsafe = next((place for place in (root, folder) if not is_trusted(place)), None)
    except OSError as error:
        raise ResourceError(
            f"cannot write to {folder} ({error.strerror}); "
            f"set {CACHE_VARIABLE} to a folder that can be written"
        ) from error
    if unsafe:
        raise ResourceError(
            f"{unsafe} holds code that is run, but is of another user, or others can write to it; "
            f"'chmod go-w' it, or set {CACHE_VARIABLE} to a folder of your own"
        )
    return folder


def make_private(folder: Path) -> None:
    """Make a folder of the cache, and those above it that are missing, for this user alone.

    Whatever the umask: where a group may write by default, the cache would refuse its own folders.
    Raises OSError.
    """
    if not folder.is_dir():
        make_private(folder.parent)
        folder.mkdir(mode=0o700, exist_ok=True)


def is_trusted(place: Path) -> bool:
    """True if nobody but this user, and the administrator, can write a file or to a folder.

    A group that has the user's name counts as the user. Raises OSError if there is no such place.
    """
    if not hasattr(os, "getuid"):  # on Windows, user folders are not for others
        return True
    status = place.stat()
    others = status.st_mode & stat.S_IWOTH
    group = status.st_mode & stat.S_IWGRP and not _is_private(status.st_gid)
    return status.st_uid in {os.getuid(), 0} and not others and not group


def _is_private(group: int) -> bool:
    """True for the administrator's group, and a group that is named as this user."""
    import grp  # noqa: PLC0415 (not on Windows)
    import pwd  # noqa: PLC0415

    try:
        return group == 0 or grp.getgrgid(group).gr_name == pwd.getpwuid(os.getuid()).pw_name
    except KeyError:  # without names
        return False
