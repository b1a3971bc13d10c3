"""What FMUs in a cell write to its standard output and error: to a file, up to a limit."""

import contextlib
import threading
import time
from array import array
from pathlib import Path
from typing import IO

from herringbone.core import HerringboneError
from herringbone.core.places.paths import cache_folder

LIMIT = 1 << 20
"""Bytes that are kept; what follows is counted only, so that no flood fills the disk."""
_PIECE = 1 << 16
_KEPT = 20
"""Logs that are kept."""
_WAIT = 1.0
_GLANCE = 1e-3


class OutputLog:
    """Reads the output of a cell in a thread; the file is made with the first byte.

    Args:
        stream: the cell's output.
        name: of the file.
    """

    def __init__(self, stream: IO[bytes], name: str) -> None:
        self._stream, self._name = stream, name
        self.file: Path | None = None
        self.size = 0
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self) -> None:
        with self._stream:
            while piece := self._piece():
                room = LIMIT - self.size
                self.size += len(piece)
                if room > 0:
                    with contextlib.suppress(OSError, HerringboneError):
                        self._write(piece[:room])

    def _piece(self) -> bytes:
        try:
            return self._stream.read1(_PIECE)  # type: ignore[attr-defined]  # it is buffered
        except (OSError, ValueError):
            return b""

    def _write(self, piece: bytes) -> None:
        if self.file is None:
            folder = cache_folder("cell-logs")
            logs = sorted(folder.glob("*.log"), key=lambda file: file.stat().st_mtime)
            for file in logs[: max(0, len(logs) - _KEPT)]:
                file.unlink(missing_ok=True)
            self.file = folder / self._name
            self.file.write_bytes(b"")
        with self.file.open("ab") as log:
            log.write(piece)

    def settle(self) -> None:
        """Wait until what was written is read."""
        import fcntl  # noqa: PLC0415 (where there are cells)
        import termios  # noqa: PLC0415

        waiting, end = array("i", [1]), time.monotonic() + _WAIT
        while waiting[0] and self._thread.is_alive() and time.monotonic() < end:
            with contextlib.suppress(OSError, ValueError):
                fcntl.ioctl(self._stream.fileno(), termios.FIONREAD, waiting)
            time.sleep(_GLANCE)

    def close(self) -> None:
        """The cell has ended."""
        self._thread.join(_WAIT)

    def described(self) -> str:
        """A line on the output; "" if there is none."""
        if self.size == 0:
            return ""
        kept = "" if self.size <= LIMIT else f", of which the first {LIMIT} are kept"
        return f"wrote {self.size} bytes of output{kept}: {self.file or 'they could not be kept'}"
