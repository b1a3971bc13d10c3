"""What scripts give, checked by kind: a wrong one is a line, and no traceback from inside."""

from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Any, TypeGuard

import numpy as np

from herringbone.core.errors import ParameterError

_SHOWN = 40


def check_mapping(name: str, given: object, example: str) -> None:
    """Refuse what has no names; raises ParameterError.

    Args:
        name: of the argument.
        given: its value; None is none.
        example: of one that is right.
    """
    if given is not None and not isinstance(given, Mapping):
        raise ParameterError(f"{name} = {_cut(given)}: it takes values by name, such as {example}")


def check_several(name: str, given: object) -> None:
    """Refuse one number or text where several are taken; raises ParameterError."""
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise ParameterError(f"{name} = {_cut(given)}: it takes several values; give [{given!r}]")


def check_reference(name: str, given: object, taken: str) -> None:
    """Refuse what is no name or path; raises ParameterError.

    Args:
        name: of the argument.
        given: its value.
        taken: what it takes, for the message.
    """
    if not isinstance(given, str | PathLike):
        raise ParameterError(f"{name} = {_cut(given)}: it takes {taken}")


def check_called(name: str, given: object) -> None:
    """Refuse what is neither True, False nor a function; raises ParameterError."""
    if not isinstance(given, bool) and not callable(given):
        raise ParameterError(f"{name} = {_cut(given)}: it takes True, False or a function")


def names(given: object, name: str) -> tuple[str, ...]:
    """A name, or several; raises ParameterError for something else, and blank ones."""
    found = several(given)
    if not all(isinstance(each, str) and each.strip() for each in found):
        raise ParameterError(f"{name} = {given!r}: it takes a name or a list of names")
    return tuple(found)


def several(given: object) -> list[Any]:
    """What a list or tuple has; anything else stands for one."""
    return list(given) if isinstance(given, list | tuple) else [given]


def is_number(value: object) -> TypeGuard[float]:
    """True for what a real variable takes: no truth value, no complex number, no text."""
    return isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)


def no_number(where: str, value: object, unit: str) -> ParameterError:
    """What is said of a value that is no number.

    Args:
        where: path of the variable.
        value: it.
        unit: of the variable.
    """
    alone = f" alone, in {unit}" if unit not in {"", "1"} else ""
    return ParameterError(f"{where} = {value!r}: it takes a number{alone}")


def _cut(given: object) -> str:
    text = repr(given)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
