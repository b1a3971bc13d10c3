"""Units of connected variables."""

from herringbone.core import StructureError
from herringbone.core.part import PartVariable


def unit_conversion(source: PartVariable, target: PartVariable, where: str) -> tuple[float, float]:
    """Factor and offset from an output's unit to an input's; 1 and 0 where they are the same.

    By the definitions that the FMUs give, as value in SI base units = factor value + offset.

    Args:
        source, target: variables with units.
        where: the connection, for messages.

    Raises:
        StructureError: the units measure different things, or one is not defined.
    """
    if source.unit == target.unit:
        return 1.0, 0.0
    if source.dimension is None or target.dimension is None:
        missing = source.unit if source.dimension is None else target.unit
        raise StructureError(
            f"connection {where}: units differ, '{source.unit}' and '{target.unit}', and "
            f"'{missing}' has no definition by base units to convert by"
        )
    (factor, offset, powers), (own, start, wanted) = source.dimension, target.dimension
    if powers != wanted:
        raise StructureError(
            f"connection {where}: units differ, '{source.unit}' and '{target.unit}'"
        )
    return factor / own, (offset - start) / own
