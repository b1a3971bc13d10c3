"""Checks that scenes share, whether read from a file or made by a caller."""

import math
from enum import StrEnum
from numbers import Real
from typing import Any, TypeVar

from herringbone.core import ParameterError

_Kind = TypeVar("_Kind", bound=StrEnum)


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
