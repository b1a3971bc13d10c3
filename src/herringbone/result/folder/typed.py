"""Dataclasses, named tuples, choices and paths as JSON, and back by their declared types.

Numbers that are not finite are texts, because JSON has none.
"""

import math
import types
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Any, Union, get_args, get_origin, get_type_hints


def as_json(value: Any) -> Any:  # noqa: ANN401 (any value that the types below can be)
    """The value as dicts, lists, texts and numbers; records by the names of their fields."""
    if is_dataclass(value) and not isinstance(value, type):
        value = {f.name: getattr(value, f.name) for f in fields(value)}
    elif isinstance(value, tuple) and hasattr(value, "_asdict"):
        value = value._asdict()
    if isinstance(value, Mapping):
        return {str(name): as_json(v) for name, v in value.items()}
    if isinstance(value, list | tuple):
        return [as_json(v) for v in value]
    return _plain(value)


def _plain(value: Any) -> Any:  # noqa: ANN401
    """A single value: a text, a number, True, False or None."""
    if isinstance(value, Enum):
        value = value.value
    elif isinstance(value, Path):
        value = str(value)
    elif hasattr(value, "item"):
        value = value.item()
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def from_json(kind: Any, found: Any) -> Any:  # noqa: ANN401 (a type, and what it tells of)
    """The value of a declared type that `as_json` made this of.

    Fields that are missing have their declared defaults; names that the type does not have are
    skipped: they are of another version.

    Raises:
        TypeError, ValueError, KeyError, AttributeError: it is none.
    """
    origin, inner = get_origin(kind), get_args(kind)
    if origin in {Union, types.UnionType}:
        some = next(k for k in inner if k is not type(None))
        return None if found is None else from_json(some, found)
    if isinstance(origin, type):
        return _collection(origin, inner, found)
    if is_dataclass(kind) or hasattr(kind, "_fields"):
        known = get_type_hints(kind)
        given = {name: v for name, v in found.items() if name in known}
        return kind(**{name: from_json(known[name], v) for name, v in given.items()})
    is_text = isinstance(kind, type) and issubclass(kind, Enum | Path | float)
    return kind(found) if is_text else found


def _collection(origin: type, inner: tuple, found: Any) -> Any:  # noqa: ANN401
    """A mapping or a tuple of values of declared types."""
    if issubclass(origin, Mapping):
        return {name: from_json(inner[1], v) for name, v in found.items()}
    if issubclass(origin, Sequence) and inner[-1:] != (Ellipsis,) and origin is tuple:
        return tuple(from_json(k, v) for k, v in zip(inner, found, strict=True))
    return tuple(from_json(inner[0], v) for v in found)
