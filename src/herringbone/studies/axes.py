"""Values of a parameter, as people write them: `500:3000:26`, `100,200,400`."""

import math
from collections.abc import Sequence

from herringbone.core import ParameterError
from herringbone.studies.study import SET_POINTS, Value

_FORM = "START:STOP:COUNT, or values with commas between them"
_MOST = 1_000_000
"""Values of a parameter."""


def axis(name: str, text: str) -> list[Value]:
    """Values from `start:stop:count`, ends included, or from a list with commas.

    Args:
        name: of the parameter, for messages; speed and torque take numbers only.
        text: as written; of an `instance.variable` also texts, such as names of files.

    Raises:
        ParameterError: it has another form.
    """
    if text.count(":") == 2 and (found := _spaced(name, text.split(":"))):
        return found
    return [_value(name, item.strip()) for item in text.split(",")]


def numbers(name: str, values: Sequence[Value]) -> list[Value]:
    """Values of speed or torque, checked; raises ParameterError."""
    for value in values:
        if isinstance(value, bool | str) or not math.isfinite(value):
            raise ParameterError(f"{name}: {value!r} is no finite number")
    return [float(value) for value in values]


def _spaced(name: str, texts: Sequence[str]) -> list[Value]:
    try:
        start, stop, count = float(texts[0]), float(texts[1]), int(texts[2])
    except ValueError:
        if name in SET_POINTS:
            raise _refused(name, ":".join(texts)) from None
        return []  # the name of a file, such as C:\...
    if not (math.isfinite(start) and math.isfinite(stop)):
        raise _refused(name, ":".join(texts))
    if not 1 <= count <= _MOST:
        raise ParameterError(
            f"{name} '{':'.join(texts)}': COUNT = {count} must lie between 1 and {_MOST}; give "
            "fewer values"
        )
    if count == 1 and start != stop:
        raise ParameterError(f"{name} {':'.join(texts)}: one value cannot be both ends")
    last = max(count - 1, 1)
    return [*(start + (stop - start) * k / last for k in range(count - 1)), stop]


def _value(name: str, text: str) -> Value:
    try:
        value = float(text)
    except ValueError:
        if name in SET_POINTS or not text:
            raise _refused(name, text) from None
        return text
    if not math.isfinite(value):
        raise _refused(name, text)
    return value


def _refused(name: str, text: str) -> ParameterError:
    return ParameterError(f"{name} '{text}': it must be {_FORM}")
