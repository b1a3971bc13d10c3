"""Mutations of files: of bytes, of lines, of numbers, words and attributes, and what overflows."""

import random
import re

_NUMBER = re.compile(rb"[+-]?\d+\.?\d*(?:[eEdD][+-]?\d+)?")
_WORD = re.compile(rb"[A-Za-z_][A-Za-z_0-9.]*")
_ATTRIBUTE = re.compile(rb'\s[\w:]+="[^"]*"')
_WIDE, _ARABIC = "\uff11\uff12".encode(), "\u0663".encode()
NUMBERS = [
    b"0", b"-1", b"-0.0", b"1e308", b"1e999", b"-1e999", b"1e-320", b"nan", b"inf", b"-inf",
    b"1_000", _WIDE, _ARABIC, b"0x1F", b"1e", b".", b"", b"1.5", b"9" * 500,
    b"9" * 5000, b"0." + b"1" * 500, b"2147483648", b"4294967296", b"9223372036854775808",
    b"1000000000000000000", b"65535", b"1e-3", b"1,5", b"+", b"true", b'"1"', b"1 2", b"1000000",
]  # fmt: skip
PIECES = [
    b"\0", b"\r", b"\r\n", b"\n", b"\t", b'"', b"'", b"<", b">", b"&", b"&a;", b"]]>", b"<!--",
    b"<!DOCTYPE x>", b"%", b"#", b",", b";", b"=", b"[", b"]", b"{", b"}", b"\\", b"\\u0000",
    b"../", b"/", b"\xff", b"\xef\xbb\xbf", "\u2028".encode(), b"\x85", b"\x1c", "ü".encode(),
    b"[" * 3000, b"{a=" * 1500, b"<a>" * 3000, b"a." * 3000, b"(" * 3000, b"x" * 40000, b"-1",
    b" " * 500, b"%n%s", b"$", b"*", b"    -1\n", b"[[", b'"""', b"\x00\x01\x02", b"PK\x03\x04",
]  # fmt: skip


def mutated(content: bytes, chance: random.Random) -> bytes:
    """One to three changes of a content."""
    for _ in range(chance.choice((1, 1, 2, 3))):
        content = chance.choice(_CHANGES)(content, chance)
    return content


def _flip(content: bytes, chance: random.Random) -> bytes:
    if not content:
        return b"x"
    found = bytearray(content)
    for _ in range(chance.choice((1, 1, 4, 16))):
        found[chance.randrange(len(found))] ^= 1 << chance.randrange(8)
    return bytes(found)


def _cut(content: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(content) + 1)
    return content[:at] if chance.random() < 0.7 else content[at:]


def _remove(content: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(content) + 1)
    return content[:at] + content[at + chance.choice((1, 2, 5, 50)) :]


def _insert(content: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(content) + 1)
    return content[:at] + chance.choice(PIECES) + content[at:]


def _lines(content: bytes, chance: random.Random) -> bytes:
    lines = content.split(b"\n")
    at, other = chance.randrange(len(lines)), chance.randrange(len(lines))
    action = chance.randrange(4)
    if action == 0:
        lines[at : at + chance.choice((1, 1, 2, 10))] = []
    elif action == 1:
        lines[at:at] = lines[at : at + chance.choice((1, 1, 2, 10))]
    elif action == 2:
        lines[at], lines[other] = lines[other], lines[at]
    else:
        lines[at] = lines[other]
    return b"\n".join(lines)


def _swap(pattern: re.Pattern[bytes], content: bytes, chance: random.Random) -> bytes:
    """Put one match in the place of another one."""
    found = list(pattern.finditer(content))
    if len(found) < 2:
        return _flip(content, chance)
    one, other = chance.choice(found), chance.choice(found)
    return content[: one.start()] + other[0] + content[one.end() :]


def _number(content: bytes, chance: random.Random) -> bytes:
    found = list(_NUMBER.finditer(content))
    if not found or chance.random() < 0.3:
        return _swap(_NUMBER, content, chance)
    one = chance.choice(found)
    return content[: one.start()] + chance.choice(NUMBERS) + content[one.end() :]


def _word(content: bytes, chance: random.Random) -> bytes:
    return _swap(_WORD, content, chance)


def _attribute(content: bytes, chance: random.Random) -> bytes:
    if chance.random() < 0.5:
        return _swap(_ATTRIBUTE, content, chance)
    found = list(_ATTRIBUTE.finditer(content))
    if not found:
        return _remove(content, chance)
    one = chance.choice(found)
    return content[: one.start()] + content[one.end() :]


def _encode(content: bytes, chance: random.Random) -> bytes:
    text = content.decode("latin-1")
    return text.encode(chance.choice(("utf-16", "utf-16-le", "utf-8", "utf-32", "utf-8-sig")))


_CHANGES = [
    *(_flip, _cut, _remove, _insert, _insert, _lines, _lines) * 2,
    *(_number,) * 8, *(_word,) * 4, *(_attribute,) * 4, _encode,
]  # fmt: skip
