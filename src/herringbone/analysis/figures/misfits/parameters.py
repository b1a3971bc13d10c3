"""Parameters of a run's parts, by what they mean."""

from herringbone.core.roles import GEARS, Quantity
from herringbone.result.result import Result


def value(result: Result, part: str, quantity: Quantity, place: str | None = None) -> float | None:
    """Parameter of a known part."""
    column = result.info.anatomy.column(part, quantity, place)
    return None if column is None else result.info.parameters.get(column)


def both(result: Result, part: str, quantity: Quantity) -> tuple[float, float] | None:
    """Parameter of both gears."""
    found = [value(result, part, quantity, gear) for gear in GEARS]
    return None if None in found else (found[0] or 0.0, found[1] or 0.0)
