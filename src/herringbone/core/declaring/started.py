"""A declaration with other start values."""

from collections.abc import Mapping
from copy import copy
from dataclasses import replace
from functools import cached_property

from herringbone.core.declaring.declaration import Declaration

_CACHED = {name for name, v in vars(Declaration).items() if isinstance(v, cached_property)}


def with_starts(declaration: Declaration, values: Mapping[str, float | str]) -> Declaration:
    """The same component with other start values, by variable or String parameter.

    Raises:
        ParameterError: there is no such variable.
    """
    texts = {text.name for text in declaration.texts}
    for name in values.keys() - texts:
        declaration.variable(name)
    found = copy(declaration)
    found.__dict__ = {k: v for k, v in vars(declaration).items() if k not in _CACHED}
    found.variables = tuple(
        replace(v, start=float(values[v.name]) + 0.0) if v.name in values else v  # no -0.0
        for v in declaration.variables
    )
    found.texts = tuple(
        replace(t, start=str(values.get(t.name, t.start))) for t in declaration.texts
    )
    return found
