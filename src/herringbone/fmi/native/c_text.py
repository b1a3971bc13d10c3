"""Values of Python as they stand in C source; the only way by which a text enters it."""

import math
import string
from collections.abc import Iterable

_PLAIN = frozenset(string.ascii_letters + string.digits + " !#$%&'()*+,-./:;<=>@[]^_`{|}~")


def array(name: str, entries: Iterable[object]) -> str:
    """A C array, or a null pointer if it is empty."""
    rows = "".join(f"    {entry},\n" for entry in entries)
    kind, _, plain = name.partition(" ")
    return (
        f"static const {name}[] = {{\n{rows}}};\n"
        if rows
        else (f"static const {kind} *const {plain} = NULL;\n")
    )


def string_array(name: str, texts: Iterable[str]) -> str:
    """Texts one behind the other, each with its end."""
    rows = "".join(f'    "{_escaped(text)}\\0"\n' for text in texts)
    return f"static const char {name}[] =\n{rows};\n"


def _escaped(text: str) -> str:
    """A text as it stands in a C string.

    What is no plain character, and ?, of which trigraphs are made, becomes an octal number.
    """
    return "".join(
        chr(byte) if chr(byte) in _PLAIN else f"\\{byte:03o}" for byte in text.encode("utf-8")
    )


def quoted(text: str) -> str:
    """A C string."""
    return f'"{_escaped(text)}"'


def number(value: float) -> str:
    """A C constant of the same bits."""
    if math.isinf(value):
        return "INFINITY" if value > 0.0 else "-INFINITY"
    return float(value).hex()
