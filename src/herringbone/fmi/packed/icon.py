"""Icon of an FMU: the teeth of a double-helical gear, as PNG."""

import struct
import zlib

_SIZE, _PITCH, _TOOTH = 64, 16, 7
_FRAME = 3
_DARK, _LIGHT, _EDGE = b"\x2f\x4b\x6e", b"\xe8\xee\xf4", b"\x1c\x2b\x3e"


def icon() -> bytes:
    """The picture, 64 x 64 pixels."""
    rows = b"".join(
        b"\0" + b"".join(_pixel(x, y) for x in range(_SIZE)) for y in range(_SIZE)
    )  # each row begins with its filter: none
    size = struct.pack(">IIBBBBB", _SIZE, _SIZE, 8, 2, 0, 0, 0)  # 8 bits, true colour
    chunks = (b"IHDR", size), (b"IDAT", zlib.compress(rows, 9)), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in chunks)


def _pixel(x: int, y: int) -> bytes:
    """Teeth that rise to the middle from both sides."""
    if not (_FRAME <= x < _SIZE - _FRAME and _FRAME <= y < _SIZE - _FRAME):
        return _EDGE
    return _DARK if (y + abs(x - _SIZE // 2) // 2) % _PITCH < _TOOTH else _LIGHT


def _chunk(kind: bytes, data: bytes) -> bytes:
    """W3C, Portable Network Graphics, section 5.3."""
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
