"""Where the command line writes: lines for people, and folders that are checked beforehand."""

import contextlib
import gc
import logging
import os
import signal
import sys
import tempfile
import threading
from collections.abc import Iterator
from errno import ENOENT
from pathlib import Path
from types import FrameType

from herringbone.core import HerringboneError
from herringbone.core.errors import reason
from herringbone.core.process.streams import write_line
from herringbone.core.process.termination import forget_signals, note_signal
from herringbone.core.wording import words_of_commands

_SELDOM = 20_000, 10, 5
"""Thresholds of Python's three generations of objects."""
_NO_MEMORY = (
    "there is no memory left; end other programs, or ask for less, such as a longer --record-step"
)
_AGAIN = 0.01
"""Time [s] after which an interruption that Python has dropped comes again."""
_OPENSSL = "[digital envelope routines]"
"""How OpenSSL's hashes begin their ValueError; ours fail only where memory does."""


def say(text: str) -> None:
    """A line about the course of a command: an error, a note; lost where nobody can read it."""
    write_line(text)


def show(text: str) -> None:
    """What a command was asked for; nothing more where who reads has left, as `head` does."""
    try:
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
    except BrokenPipeError:
        with Path(os.devnull).open("w") as nowhere:
            os.dup2(nowhere.fileno(), sys.stdout.fileno())


@contextlib.contextmanager
def limits_told() -> Iterator[None]:
    """Context in which what the machine does not give is an error of ours; it raises these.

    What concerns a file that was asked for is told better where it is read or written.
    """
    try:
        yield
    except (MemoryError, SystemError) as error:  # the second where a library forgets to say so
        raise HerringboneError(_NO_MEMORY) from error
    except ValueError as error:
        if not str(error).startswith(_OPENSSL):
            raise
        raise HerringboneError(_NO_MEMORY) from error
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        raise HerringboneError(f"{where}{reason(error)}") from error


@contextlib.contextmanager
def as_command() -> Iterator[None]:
    """Context of a whole command: it can be ended, shows warnings, and tells what it lacks."""
    with words_of_commands(), terminable(), logged(), seldom_collected(), limits_told():
        yield


class _Lines(logging.Handler):
    """Shows warnings of the library as lines."""

    def emit(self, record: logging.LogRecord) -> None:
        """A record as a line."""
        say(self.format(record))


@contextlib.contextmanager
def logged() -> Iterator[None]:
    """Context in which warnings of the library are shown."""
    logger, lines = logging.getLogger("herringbone"), _Lines(logging.WARNING)
    logger.addHandler(lines)
    try:
        yield
    finally:
        logger.removeHandler(lines)


def _terminated(number: int, frame: FrameType | None) -> None:
    """Handler of SIGTERM."""
    note_signal(number)
    signal.default_int_handler(number, frame)


@contextlib.contextmanager
def terminable() -> Iterator[None]:
    """Context in which SIGTERM ends a command as SIGINT does; only in the main thread."""
    forget_signals()
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _terminated)
    try:
        with _not_dropped():
            yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextlib.contextmanager
def _not_dropped() -> Iterator[None]:
    """Context in which interruptions come again that Python drops.

    It does where one comes in a destructor or a function that C has called, as LLVM's have.
    """

    def told(dropped: "sys.UnraisableHookArgs") -> None:
        if issubclass(dropped.exc_type, KeyboardInterrupt):
            signal.setitimer(signal.ITIMER_REAL, _AGAIN)
        else:
            tell(dropped)

    tell, sys.unraisablehook = sys.unraisablehook, told
    alarm = signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, alarm)
        sys.unraisablehook = tell


@contextlib.contextmanager
def seldom_collected() -> Iterator[None]:
    """Context in which Python seldom searches the millions of objects of numba for cycles.

    The searches take a tenth of a command, and a third of drawing its pictures.
    """
    before = gc.get_threshold()
    gc.set_threshold(*_SELDOM)
    try:
        yield
    finally:
        gc.set_threshold(*before)


def check_current_folder() -> None:
    """Refuse to begin in a folder that has been removed; raises HerringboneError."""
    try:
        Path.cwd()
    except FileNotFoundError as error:
        raise HerringboneError("the current folder is gone; cd to another") from error


def check_writable(folder: Path, file: Path | None = None) -> None:
    """Refuse before a run what would fail after it; leaves nothing behind.

    Args:
        folder: in which something is to be written.
        file: the one that was asked for, if it was one.

    Raises:
        HerringboneError: the folder cannot be made or written.
    """
    there = next(f for f in (folder, *folder.absolute().parents) if f.exists())
    try:
        with tempfile.TemporaryDirectory(dir=there):
            pass
    except OSError as error:
        why = f"nothing can be made in {there}" if error.errno == ENOENT else reason(error)
        raise (
            HerringboneError(f"cannot write {file}: {why}; choose another file with -o")
            if file
            else _refused(folder, why)
        ) from error


@contextlib.contextmanager
def written_into(folder: Path) -> Iterator[None]:
    """Context in which files of a folder are written, which is made if it is not there.

    Raises:
        HerringboneError: the folder cannot be made, or a file cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        yield
    except OSError as error:
        raise _refused(folder, reason(error)) from error


def _refused(folder: Path, why: str) -> HerringboneError:
    return HerringboneError(f"cannot write to {folder}: {why}; choose another folder with -o")
