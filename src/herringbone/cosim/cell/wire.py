"""Text between a master and a cell: JSON, which tells a damaged message from a whole one."""

import json
from typing import Any

import numpy as np

from herringbone.core import FmuError

_BYTES = "bytes"


def packed(message: object) -> bytes:
    """A message as bytes; numbers keep all their digits."""
    return json.dumps(_plain(message)).encode("ascii")


def unpacked(content: bytes) -> Any:  # noqa: ANN401 (as it was packed)
    """The message; raises FmuError."""
    try:
        return _own(json.loads(content))
    except (ValueError, RecursionError) as error:
        raise FmuError(f"the message of a cell is damaged: {error}") from error


def _plain(value: object) -> object:
    if isinstance(value, bytes):
        return {_BYTES: value.hex()}
    if isinstance(value, dict):
        return {name: _plain(content) for name, content in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(content) for content in value]
    if isinstance(value, np.generic | np.ndarray):
        return _plain(value.tolist())
    return value


def _own(value: object) -> object:
    if isinstance(value, dict):
        if value.keys() == {_BYTES}:
            return bytes.fromhex(value[_BYTES])
        return {name: _own(content) for name, content in value.items()}
    return [_own(content) for content in value] if isinstance(value, list) else value
