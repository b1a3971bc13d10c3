"""The standard streams of a process, which may be closed, full, or read by nobody."""

import contextlib
import os
import sys
from pathlib import Path
from typing import TextIO

_STREAMS = ("stdin", "r"), ("stdout", "w"), ("stderr", "w")
"""By their numbers."""


def open_streams() -> None:
    """Make the standard streams of a command usable, whatever its caller has done to them.

    Those that were closed, as by `>&-`, read and write nothing. The lowest number that is free is
    taken first, so that no file of results becomes the stream of a library or of another process.
    What the encoding of stdout does not have is escaped.
    """
    for name, mode in _STREAMS:
        if getattr(sys, name) is None:
            stream = Path(os.devnull).open(mode, encoding="utf-8")  # noqa: SIM115 (it stays open)
            os.set_inheritable(stream.fileno(), True)
            setattr(sys, name, stream)
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")


def write_line(line: str) -> None:
    """Write a line to stderr, as it is at the moment, above progress bars.

    Where that cannot be, as on a full disk or where who reads has left, the line is lost: what is
    computed is worth more.
    """
    stream, bars = sys.stderr, sys.modules.get("tqdm")
    if stream is None:  # closed, or a program without a terminal
        return
    try:
        if bars is not None:
            bars.tqdm.write(line, file=stream)
        else:
            stream.write(line + "\n")
    except OSError:
        _drop(stream)


def _drop(stream: TextIO) -> None:
    """Lose what a stream could not write; it would fail again with the next line, and at exit."""
    with contextlib.suppress(OSError):  # a stream of a notebook has no number
        kept = os.dup(stream.fileno())
        with Path(os.devnull).open("w") as nowhere:
            os.dup2(nowhere.fileno(), stream.fileno())
        try:
            stream.flush()
        finally:
            os.dup2(kept, stream.fileno())
            os.close(kept)
