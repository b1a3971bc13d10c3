"""Which folder a run may write into: nothing of another run is overwritten unasked."""

import itertools
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from herringbone.core import HerringboneError, ResourceError
from herringbone.core.errors import reason
from herringbone.core.places.files import is_file
from herringbone.core.wording import option
from herringbone.result.folder.names import REPLACED, SUMMARY, State
from herringbone.result.folder.run_file import read_run_file

try:
    import fcntl
except ImportError:  # on Windows: no locks there
    fcntl = None  # type: ignore[assignment]


@dataclass(frozen=True)
class Claim:
    """What a run wants to write where.

    Attributes:
        folder: that was asked for.
        named: by the user; else the folder may get a number.
        key: of the run's settings.
        settings: digests by name.
        overwrite: whatever is there may be replaced.
    """

    folder: Path
    named: bool
    key: str
    settings: Mapping[str, str]
    overwrite: bool = False


def claimed(claim: Claim) -> "FolderLock":
    """The folder into which the run may write, kept from others from here on.

    Raises:
        HerringboneError: another run is there, or writes there.
    """
    for folder in _candidates(claim.folder):
        try:
            lock = FolderLock(folder)
        except FolderBusyError:
            if claim.named or claim.overwrite or _holds(folder, claim.key):
                raise
            continue
        why = None if claim.overwrite else _taken(folder, claim)
        if why is None:
            return lock
        lock.release()
        if claim.named or why.own:
            raise HerringboneError(f"{folder} {why.text}")
    raise AssertionError("there is always another number")


def _candidates(folder: Path) -> Iterator[Path]:
    """A folder, and others with numbers."""
    yield folder
    for number in itertools.count(2):
        yield folder.with_name(f"{folder.name}-{number}")


def _holds(folder: Path, key: str) -> bool:
    """True if a run of these settings is there, as far as that can be read."""
    try:
        found = read_run_file(folder)
    except ResourceError:
        return False
    return found is not None and found.key == key


@dataclass(frozen=True)
class _Taken:
    """Why a folder is not to be overwritten; own: by a run of the same settings."""

    text: str
    own: bool = False


def _taken(folder: Path, claim: Claim) -> _Taken | None:
    """Why a folder that is locked is not to be overwritten; None if it may be."""
    anew = option("overwrite", True)
    try:
        found = read_run_file(folder)
    except ResourceError as error:
        return _Taken(f"holds a run that cannot be read ({error}); use another folder, or {anew}")
    if found is None:
        if is_file(folder / SUMMARY):
            return _Taken(f"holds results of an older version; choose another folder, or {anew}")
        others = [name for name in REPLACED if is_file(folder / name)]
        what = (
            f"holds {', '.join(others)} of no run, which would be replaced; choose another folder"
        )
        return _Taken(f"{what}, or {anew}") if others else None
    if found.key != claim.key:
        names = [n for n, d in claim.settings.items() if found.settings.get(n) != d]
        return _Taken(
            f"holds a run of other settings ({', '.join(names)}); choose another folder, or {anew}"
        )
    if found.state is State.RUNNING:
        resume = f"go on with 'herringbone run --resume {folder}', or " if found.asked else ""
        return _Taken(f"holds this run, but cut off; {resume}begin anew with {anew}", own=True)
    return None


class FolderBusyError(HerringboneError):
    """Another process writes into a folder."""


class FolderLock:
    """A folder that is made, and that one process writes into at a time.

    Args:
        folder: is made if it is not there.

    Attributes:
        folder: likewise.

    Raises:
        HerringboneError: it cannot be made.
        FolderBusyError: another process writes into it.
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self._descriptor = folder, -1
        self._made: list[Path] = []
        try:
            self._made = [place for place in (folder, *folder.parents) if not place.exists()]
            folder.mkdir(parents=True, exist_ok=True)
            if fcntl is None:
                return
            self._descriptor = os.open(folder, os.O_RDONLY | os.O_CLOEXEC)
        except OSError as error:
            raise HerringboneError(
                f"cannot write {folder}: {reason(error)}; choose another folder"
            ) from error
        try:
            fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self._close()
            raise FolderBusyError(
                f"another run is writing into {folder}; wait for it, or choose another folder"
            ) from None
        except OSError:  # a file system without locks
            return

    def release(self) -> None:
        """Let others write; folders that were made and are empty go."""
        for place in self._made:
            try:
                place.rmdir()
            except OSError:  # something is in it
                break
        self._made = []
        self._close()

    def _close(self) -> None:
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1
