"""Recorded values, back in the units of their variables."""

from collections.abc import Sequence

import numpy as np

from herringbone.core.part import PartVariable


def own_unit(variable: PartVariable) -> str:
    """Unit in which a variable is recorded, "" if none is declared."""
    return variable.own_unit[0] if variable.own_unit else variable.unit or ""


def in_own_units(variables: Sequence[PartVariable], values: np.ndarray) -> np.ndarray:
    """Recorded values (n, m) in the units of their variables (m)."""
    if not any(v.own_unit for v in variables):
        return values
    found = values.copy()
    for k, variable in enumerate(variables):
        if variable.own_unit:
            _, factor, offset = variable.own_unit
            found[:, k] = (values[:, k] - offset) / factor
    return found
