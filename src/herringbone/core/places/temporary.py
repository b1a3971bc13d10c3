"""Temporary folders that do not outlive the process that made them for long.

A folder is locked as long as its process lives, however that ends; whoever makes the next one
removes those of dead processes. A lock, not a process number: those are not the same in all
containers that share a folder for temporary files.
"""

import contextlib
import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path

_PREFIX = "herringbone_run_"
_YOUNG = 60.0
"""Seconds in which a folder may not have been locked yet."""

_locks: dict[Path, int] = {}


def make_temporary_folder() -> Path:
    """A new folder, for this user alone; see `remove_temporary_folder`.

    Raises:
        OSError: it cannot be made.
    """
    _sweep()
    folder = Path(tempfile.mkdtemp(prefix=_PREFIX))
    with contextlib.suppress(OSError, ImportError):  # where there are no locks, nothing is swept
        _locks[folder] = _locked(folder)
    return folder


def remove_temporary_folder(folder: Path) -> None:
    """Remove a folder with all that it holds; what cannot be removed stays."""
    shutil.rmtree(folder, ignore_errors=True)
    lock = _locks.pop(folder, None)
    if lock is not None:
        os.close(lock)


@contextlib.contextmanager
def temporary_folder() -> Iterator[Path]:
    """A folder that is removed when the context ends."""
    folder = make_temporary_folder()
    try:
        yield folder
    finally:
        remove_temporary_folder(folder)


@contextlib.contextmanager
def filled_folder() -> Iterator[Path]:
    """A folder that stays, unless what fills it raises or is interrupted."""
    folder = make_temporary_folder()
    try:
        yield folder
    except BaseException:
        remove_temporary_folder(folder)
        raise


def _locked(folder: Path) -> int:
    """Descriptor of a folder, locked; raises OSError if another process has it."""
    import fcntl  # noqa: PLC0415 (not on Windows)

    descriptor = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(descriptor)
        raise
    return descriptor


@cache
def _sweep() -> None:
    """Remove this user's folders of processes that are dead; once in a process."""
    for folder in Path(tempfile.gettempdir()).glob(f"{_PREFIX}*"):
        with contextlib.suppress(OSError, ImportError):
            status = folder.lstat()
            old = time.time() - status.st_mtime > _YOUNG
            if old and folder.is_dir() and not folder.is_symlink() and _is_own(status.st_uid):
                descriptor = _locked(folder)
                shutil.rmtree(folder, ignore_errors=True)
                os.close(descriptor)


def _is_own(owner: int) -> bool:
    return not hasattr(os, "getuid") or owner == os.getuid()
