"""Numbers in texts of strangers: one grammar, which is also that of the native readers.

A decimal number in ASCII, perhaps with sign, point and exponent, between blanks. No 1_000, no
digits of other scripts, no inf, nan or hexadecimal, and no more than `LONGEST` characters.
"""

import re
from typing import Final

LONGEST: Final = 400
"""Characters of a number: more than 1e308 has, written out; `fmi/native/c` has the same limit."""
_BLANK = " \t\v\f"
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_WHOLE = re.compile(r"[+-]?[0-9]{1,20}")
_INFINITE = float("inf")


def number(text: str) -> float:
    """A finite number; raises ValueError."""
    word = text.strip(_BLANK)
    if len(word) <= LONGEST and _NUMBER.fullmatch(word):
        value = float(word)
        if abs(value) < _INFINITE:
            return value
    raise ValueError(f"'{_cut(word)}' is not a finite number")


def whole(text: str) -> int:
    """A whole number of at most 20 digits, as the longest of 64 bits has; raises ValueError."""
    word = text.strip(_BLANK)
    if not _WHOLE.fullmatch(word):
        raise ValueError(f"'{_cut(word)}' is not a whole number")
    return int(word)


def _cut(word: str) -> str:
    return word if len(word) <= 64 else word[:64]
