"""Units of connected variables."""

import math

from herringbone.core import StructureError
from herringbone.core.part import PartVariable


def unit_conversion(source: PartVariable, target: PartVariable, where: str) -> tuple[float, float]:
    """Factor and offset from an output's unit to an input's; 1 and 0 where they are the same.

    By the definitions that the FMUs give, as value in SI base units = factor value + offset.

    Args:
        source, target: variables with units.
        where: the connection, for messages.

    Raises:
        StructureError: the units measure different things, or one is not defined, or by numbers
            that are no conversion.
    """
    if source.unit == target.unit:
        return 1.0, 0.0
    if source.dimension is None or target.dimension is None:
        missing = source.unit if source.dimension is None else target.unit
        raise StructureError(
            f"connection {where}: units differ, '{source.unit}' and '{target.unit}', and "
            f"'{missing}' has no definition by base units to convert by"
        )
    if source.dimension[2] != target.dimension[2]:
        raise StructureError(
            f"connection {where}: units differ, '{source.unit}' and '{target.unit}'"
        )
    return conversion_by_definitions(source, target, where)


def conversion_by_definitions(
    source: PartVariable, target: PartVariable, where: str
) -> tuple[float, float]:
    """Factor and offset from an output to an input; what has no unit is in SI units.

    Raises:
        StructureError: a definition is no conversion.
    """
    factor, offset = _to_si(source, where)
    own, start = _to_si(target, where)
    return factor / own, (offset - start) / own


def _to_si(variable: PartVariable, where: str) -> tuple[float, float]:
    factor, offset = variable.dimension[:2] if variable.dimension else (1.0, 0.0)
    if factor == 0.0 or not (math.isfinite(factor) and math.isfinite(offset)):
        raise StructureError(
            f"connection {where}: unit '{variable.unit}' has the factor {factor:g} and the offset "
            f"{offset:g} to SI units; no value can be converted"
        )
    return factor, offset
