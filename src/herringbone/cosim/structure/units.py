"""Units of connected variables."""

from herringbone.core import StructureError
from herringbone.core.part import PartVariable, to_si


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
    factor, offset = to_si(source, f"connection {where}", StructureError)
    own, start = to_si(target, f"connection {where}", StructureError)
    return factor / own, (offset - start) / own
