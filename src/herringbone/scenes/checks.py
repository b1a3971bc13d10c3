"""Checks that scenes share, whether read from a file or made by a caller."""

import math
from enum import StrEnum
from numbers import Real
from typing import Any, TypeVar

from herringbone.core import ParameterError
from herringbone.core.given import several

_Kind = TypeVar("_Kind", bound=StrEnum)
_ENDS = 2


def chosen(kind: type[_Kind], given: Any, name: str) -> _Kind:  # noqa: ANN401 (anything from TOML)
    """The choice that a text names: `is` tells it from others, a text only `==` does.

    Args:
        kind: of choices.
        given: a choice, or its text.
        name: of what is chosen, for the message.

    Raises:
        ParameterError: there is no such choice.
    """
    if given not in list(kind):
        raise ParameterError(f"{name} = {given!r}; it must be one of {', '.join(kind)}")
    return kind(given)


def duration(given: Any, name: str) -> float:  # noqa: ANN401
    """A time [s] that is positive and finite.

    Args:
        given: a number.
        name: of it, for the message.

    Raises:
        ParameterError: it is none, or out of range.
    """
    if isinstance(given, bool) or not isinstance(given, Real):
        raise ParameterError(f"{name} = {given!r}: it takes a number of seconds")
    value = float(given)
    if not (math.isfinite(value) and value > 0.0):
        raise ParameterError(f"{name} = {value:g} s: it must be positive and finite")
    return value


def number(given: Any, name: str) -> float:  # noqa: ANN401
    """A finite number; raises ParameterError."""
    if isinstance(given, bool) or not isinstance(given, Real) or not math.isfinite(given):
        raise ParameterError(f"{name} = {given!r}: it takes a finite number")
    return float(given)


def ends(given: Any, name: str, *, still: bool = True) -> tuple[float, float]:  # noqa: ANN401
    """A range from a number, which is both ends, or from two.

    Args:
        given: it.
        name: of it, for the message.
        still: 0 may be in it.

    Raises:
        ParameterError: it is none, its ends are the wrong way round, or 0 is in it and must not be.
    """
    found = several(given) if isinstance(given, list | tuple) else [given, given]
    if len(found) != _ENDS:
        raise ParameterError(f"{name} = {given!r}: a number, or [LOWEST, HIGHEST]")
    low, high = (number(end, name) for end in found)
    if low > high or (not still and low <= 0.0 <= high):
        hint = "" if still else ", and no standstill between"
        raise ParameterError(f"{name} = [{low:g}, {high:g}]: the lower one first{hint}")
    return low, high
