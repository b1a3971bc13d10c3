"""A result but for its rows, as it stands in `run.json`."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, get_type_hints

import pandas as pd

from herringbone.result.folder.typed import as_json, from_json
from herringbone.result.result import Result

_ROWS = {"data", "whole", "before", "units"}
_TYPES = {name: kind for name, kind in get_type_hints(Result).items() if name not in _ROWS}


def stored_result(result: Result) -> dict[str, Any]:
    """All about a result but its rows and units, which stand elsewhere."""
    names = [f.name for f in fields(Result) if f.name in _TYPES]
    return {name: as_json(getattr(result, name)) for name in names}


def result_of(found: Mapping[str, Any], data: pd.DataFrame, units: Mapping[str, str]) -> Result:
    """The result of these rows.

    Raises:
        TypeError, ValueError, KeyError, AttributeError: it is none.
    """
    known = {name: from_json(_TYPES[name], v) for name, v in found.items() if name in _TYPES}
    return Result(data, dict(units), **known)
