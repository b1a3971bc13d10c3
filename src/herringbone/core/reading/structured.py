"""TOML and JSON of strangers, as dicts of finite numbers, texts, lists and dicts."""

import json
import math
import re
import tomllib
from collections.abc import Mapping
from typing import Any, Final

from herringbone.core.errors import HerringboneError, ResourceError
from herringbone.core.reading.numbers import LONGEST, number
from herringbone.core.reading.texts import MEBIBYTE, AnyPath, read_text

_LARGEST_TOML: Final = MEBIBYTE
_LARGEST_WHOLE: Final = 2**63 - 1
"""TOML and JSON promise no larger whole numbers."""
_MOST_DOTS: Final = 100
"""Of a key: the time that TOML takes grows with their square."""
_LONG_KEY = re.compile(
    rf"""(?<![\w-])(?:["']?+[\w-]++["']?+[ \t]*+\.[ \t]*+){{{_MOST_DOTS + 1}}}""", re.ASCII
)
_DEEPEST: Final = 50


def read_toml(file: AnyPath, error: type[HerringboneError] = ResourceError) -> dict[str, Any]:
    """Content of a TOML file.

    Args:
        file: the file.
        error: what is raised.

    Raises:
        HerringboneError: of the kind `error`: it cannot be read, is no TOML, is nested too deeply,
            or has a number that is not finite or too long.
    """
    text = read_text(file, error, most=_LARGEST_TOML)
    try:
        _check_keys(text)
        found = tomllib.loads(text, parse_float=_toml_number)
        _check(found)
    except RecursionError:
        raise error(f"cannot read {file}: it is nested too deeply") from None
    except ValueError as damage:  # of which TOMLDecodeError is one
        raise error(f"cannot read {file}: {damage}") from None
    return found


def read_json(file: AnyPath, error: type[HerringboneError] = ResourceError) -> dict[str, Any]:
    """Content of a JSON file that is one object; see `read_toml`."""
    text = read_text(file, error)
    try:
        found = json.loads(
            text, parse_constant=number, parse_float=number, parse_int=_whole_of_json
        )
        _check(found)
    except RecursionError:
        raise error(f"cannot read {file}: it is nested too deeply") from None
    except ValueError as damage:
        raise error(f"{file} is no valid JSON: {damage}") from None
    if not isinstance(found, dict):
        raise error(f"{file}: it must be one JSON object")
    return found


def _toml_number(text: str) -> float:
    """As TOML has it, with underscores; that it is finite is checked where its place is known."""
    if len(text) > LONGEST:
        raise ValueError(f"'{text[:40]}...' is too long a number")
    return float(text)


def _whole_of_json(text: str) -> int:
    if len(text) > LONGEST:
        raise ValueError(f"'{text[:40]}...' is too long a number")
    return int(text)


def _check_keys(text: str) -> None:
    if _LONG_KEY.search(text):
        raise ValueError(f"it has a key of more than {_MOST_DOTS} parts")


def _check(value: object, place: str = "", depth: int = 0) -> None:
    """Raise ValueError if a value is nested too deeply or a number is too large."""
    if depth > _DEEPEST:
        raise ValueError(f"{place[:40]} ... is nested too deeply")
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError(f"{place} = {value} is not a finite number")
    if isinstance(value, int) and abs(value) > _LARGEST_WHOLE:
        raise ValueError(f"{place} is a whole number of more than 64 bits")
    items: Any = ()
    if isinstance(value, Mapping):
        items = value.items()
    elif isinstance(value, list):
        items = enumerate(value, 1)
    for name, inner in items:
        if isinstance(inner, int | float | list | dict):
            _check(inner, f"{place}.{name}" if place else str(name), depth + 1)
