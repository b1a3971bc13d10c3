"""A study from a TOML file: a grid, a list of points, or a sample."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from herringbone.core import ParameterError
from herringbone.core.places.files import beside
from herringbone.core.reading.structured import read_toml
from herringbone.studies.axes import axis, numbers
from herringbone.studies.study import (
    PER_MINUTE,
    SET_POINTS,
    Point,
    Study,
    Value,
    grid,
    listed,
    sampled,
)

_KINDS = ("grid", "point", "sample")
_ENDS = 2


def read_study_file(file: str | Path) -> Study:
    """Read a study, with speeds in r/min; see `herringbone template study`.

    Raises:
        HerringboneError: it cannot be read, or something in it is wrong.
    """
    file = Path(file)
    data = read_toml(file, ParameterError)
    given = [kind for kind in _KINDS if kind in data]
    if len(given) != 1 or set(data) != set(given):
        raise ParameterError(
            f"{file}: it must have one of [grid], [[point]] and [sample], and nothing else"
        )
    content = data[given[0]]
    try:
        if given == ["grid"]:
            found = grid({n: _axis(n, v, file) for n, v in _table(content, "grid").items()})
        elif given == ["point"]:
            found = listed([_point(each, file) for each in content])
        else:
            found = _sample(_table(content, "sample"))
        return replace(found, speed_unit=PER_MINUTE)
    except ParameterError as error:
        raise ParameterError(f"{file}: {error}") from None


def _table(content: Any, name: str) -> Mapping[str, Any]:  # noqa: ANN401 (anything from TOML)
    if not isinstance(content, dict):
        raise ParameterError(f"{name}: it takes a table")
    return content


def _axis(name: str, given: Any, file: Path) -> list[Value]:  # noqa: ANN401
    if isinstance(given, str):
        return [beside(value, file.parent) for value in axis(name, given)]
    if not isinstance(given, list):
        raise ParameterError(f"{name} = {given!r}: it takes a list, or a text START:STOP:COUNT")
    return [_value(name, value, file) for value in given]


def _value(name: str, value: Any, file: Path) -> Value:  # noqa: ANN401
    if isinstance(value, str) and name not in SET_POINTS:
        return beside(value, file.parent)
    return numbers(name, [value])[0]


def _point(content: Any, file: Path) -> Point:  # noqa: ANN401
    return {name: _value(name, value, file) for name, value in _table(content, "point").items()}


def _sample(content: Mapping[str, Any]) -> Study:
    known = {"count", "seed", "between"}
    count, seed = content.get("count"), content.get("seed", 0)
    if set(content) - known or not isinstance(count, int) or count < 1 or not isinstance(seed, int):
        raise ParameterError(
            "sample: it takes count, a whole number of at least 1, seed, a whole number, and the "
            "table [sample.between]"
        )
    between = {}
    for name, ends in _table(content.get("between", {}), "sample.between").items():
        if not isinstance(ends, list) or len(ends) != _ENDS:
            raise ParameterError(f"sample.between: {name} takes [LOWEST, HIGHEST]")
        low, high = (float(end) for end in numbers(name, ends))
        if low >= high:
            raise ParameterError(f"sample.between: {name} = {ends}: the first must be the lower")
        between[name] = (low, high)
    if not between:
        raise ParameterError("sample.between: it has no parameters")
    return sampled(between, count, seed)
