"""Values of all FMI types, from what people and files give."""

import math
import re
from collections.abc import Sequence

import numpy as np

from herringbone.core import ParameterError
from herringbone.core.names import shown
from herringbone.core.part import Value, ValueOrArray

INTEGERS = {
    "Integer": np.dtype(np.int32),
    **{f"{kind}{n}": np.dtype(f"{kind.lower()}{n}")
       for kind in ("Int", "UInt") for n in (8, 16, 32, 64)},
}  # fmt: skip
"""Integer types of FMI 2.0 and 3.0."""
REALS = {"Real", "Float64", "Float32"}
_WHOLE = re.compile(r"[+-]?[0-9]{1,19}")
"""Number of an enumeration's item."""
_WORDS = {"true": True, "false": False, "1": True, "0": False}


_COLUMNS = {
    **INTEGERS,
    "Float32": np.dtype(np.float32),
    "Boolean": np.dtype(np.bool_),
    "Enumeration": np.dtype(np.int64),
}


def column_type(kind: str) -> np.dtype:
    """Type of a table's column of an FMI type."""
    return _COLUMNS.get(kind, np.dtype(object))


def as_value(kind: str, given: Value, what: str, items: Sequence[tuple[str, int]] = ()) -> Value:
    """A value as an FMU's function of that type takes it.

    Args:
        kind: FMI type.
        given: number, text, truth value or bytes; bytes also as hexadecimal digits.
        what: variable and value, for messages.
        items: numbers of an enumeration by name.

    Raises:
        ParameterError: it is of another type, not finite, or out of the type's range.
    """
    if kind == "String" and isinstance(given, str):
        return given
    if kind == "Binary":
        return _bytes(given, what)
    if kind == "Boolean":
        return _truth(given, what)
    if kind == "Enumeration":
        return _item(given, what, items)
    if kind in INTEGERS:
        limits = np.iinfo(INTEGERS[kind])
        return _whole(given, kind, what, int(limits.min), int(limits.max))
    if kind in REALS and isinstance(given, float | int) and not isinstance(given, bool):
        return _real(given, kind, what)
    number = ", a number" if kind in REALS else ""
    raise ParameterError(f"{what}: it takes a {kind}{number}")


def _real(given: float, kind: str, what: str) -> float:
    try:
        value = float(given)
    except OverflowError:
        value = math.inf
    if not math.isfinite(value):
        raise ParameterError(f"{what}: it must be finite")
    if kind == "Float32" and abs(value) > float(np.finfo(np.float32).max):
        raise ParameterError(f"{what}: it is too large for a Float32")
    return value


def _whole(given: Value, kind: str, what: str, least: int, most: int) -> int:
    if isinstance(given, float) and not math.isfinite(given):
        raise ParameterError(f"{what}: it must be finite")
    if isinstance(given, str | bytes) or given != int(given):
        raise ParameterError(f"{what}: its type is {kind}, it takes a whole number")
    if not least <= int(given) <= most:
        raise ParameterError(f"{what}: the type {kind} goes from {least} to {most}")
    return int(given)


def _truth(given: Value, what: str) -> bool:
    word = given.lower() if isinstance(given, str) else str(given).lower()
    word = word.removesuffix(".0")
    if word not in _WORDS:
        raise ParameterError(f"{what}: it takes a Boolean, true or false")
    return _WORDS[word]


def _item(given: Value, what: str, items: Sequence[tuple[str, int]]) -> int:
    by_name = dict(items)
    if isinstance(given, str) and given in by_name:
        return by_name[given]
    listed = ", ".join(f"{number} ({shown(name)})" for name, number in items)
    if isinstance(given, str | bytes) or (items and given not in by_name.values()):
        raise ParameterError(f"{what}: it takes an Enumeration, one of {listed or 'its numbers'}")
    return _whole(given, "Enumeration", what, -(2**63), 2**63 - 1)


def _bytes(given: Value, what: str) -> bytes:
    if isinstance(given, bytes):
        return given
    if not isinstance(given, str):
        raise ParameterError(
            f"{what}: it takes a Binary, as hexadecimal digits; in quotes, "
            "--set 'PART.VARIABLE=\"0102\"', where these could be a number"
        )
    try:
        return bytes.fromhex(given)
    except ValueError:
        raise ParameterError(f"{what}: it takes a Binary, as hexadecimal digits") from None


def as_values(
    kind: str, given: ValueOrArray, count: int, what: str, items: Sequence[tuple[str, int]] = ()
) -> list[Value]:
    """Values of all elements of an array; a text of numbers is split at its blanks.

    Raises:
        ParameterError: their number is another, or one is wrong, see `as_value`.
    """
    found = _listed(kind, given, what)
    if len(found) != count:
        raise ParameterError(f"{what}: it takes {count} values of type {kind}, not {len(found)}")
    return [as_value(kind, value, what, items) for value in found]


def _listed(kind: str, given: ValueOrArray, what: str) -> list[Value]:
    if isinstance(given, str) and kind != "String":
        given = given.split()
        if kind in REALS or kind in INTEGERS:
            return [number(text, what) for text in given]
        if kind == "Enumeration":
            return [int(text) if _WHOLE.fullmatch(text) else text for text in given]
    if isinstance(given, str | bytes | float | int):
        return [given]
    rows = [_listed(kind, row, what) if isinstance(row, list | tuple) else [row] for row in given]
    return [value for row in rows for value in row]


def number(text: str, what: str) -> float:
    """A number of a text: a whole one without loss; raises ParameterError."""
    try:
        return int(text)
    except ValueError:
        pass
    try:
        return float(text)
    except ValueError:
        raise ParameterError(f"{what}: {shown(text)} is no number") from None
