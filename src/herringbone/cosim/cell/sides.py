"""One side of a shared block, as compiled code knows it."""

import ctypes
import mmap

import numpy as np

from herringbone.cosim.cell.block import HEADER, HEADER_TYPE, SIDE, SPIN, TEXT_BYTES, Places

_PR_SET_TIMERSLACK = 29


class Side:
    """The block, mapped, and the record of this side.

    Args:
        block: file descriptor of the memory; it is not needed afterwards.
        layout: of the block.
        capacity: words of operations.
        sleep: time after which a sleeper looks around [s].
    """

    def __init__(self, block: int, layout: Places, capacity: int, sleep: float) -> None:
        self._map = mmap.mmap(block, layout.size)
        self._bytes = np.frombuffer(self._map, np.uint8)
        address = self._bytes.ctypes.data
        self._text = self._bytes[layout.text :]
        self.header = self._bytes[HEADER : HEADER + HEADER_TYPE.itemsize].view(HEADER_TYPE)
        self.record = np.zeros(1, SIDE)
        self._now, self._timeout, self._nap = (np.zeros(2, np.int64) for _ in range(3))
        self.poll = np.zeros(1, np.int64)
        self._timeout[:] = int(sleep), int(1e9 * (sleep % 1.0))  # timespec: s, and ns below 1e9
        c = ctypes.CDLL(None)
        c.prctl(_PR_SET_TIMERSLACK, ctypes.c_ulong(1))  # naps end when they shall [ns]
        values = {
            "block": address,
            "words": address + layout.words,
            "values": address + layout.values,
            "capacity": capacity,
            "now": self._now.ctypes.data,
            "timeout": self._timeout.ctypes.data,
            "watched": self.poll.ctypes.data,
            "nap": self._nap.ctypes.data,
        }
        for name, function in (
            ("syscall", c.syscall),
            ("clock", c.clock_gettime),
            ("poll", c.poll),
        ):
            values[name] = ctypes.cast(function, ctypes.c_void_p).value or 0
        for name, value in values.items():
            self.record[name] = value

    def spin(self, seconds: float) -> None:
        """Time to spin, for both sides."""
        self._bytes[SPIN : SPIN + 4].view(np.int32)[0] = int(1e9 * seconds)

    @property
    def address(self) -> int:
        """Address of the record."""
        return self.record.ctypes.data

    def write(self, content: bytes) -> bytes:
        """Put text into the block; what did not fit."""
        now, later = content[:TEXT_BYTES], content[TEXT_BYTES:]
        self._text[: len(now)] = np.frombuffer(now, np.uint8)
        self.header["text"], self.header["more"] = len(now), bool(later)
        return later

    def read(self) -> tuple[bytes, bool]:
        """Text in the block, and whether more follows."""
        size = min(max(int(self.header["text"][0]), 0), TEXT_BYTES)
        return self._text[:size].tobytes(), bool(self.header["more"][0])
