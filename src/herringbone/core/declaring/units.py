"""The units that variables may carry, as exponents of kg, m, s and rad."""

import math
from collections.abc import Iterable
from typing import Final

from herringbone.core.errors import StructureError

R_MIN: Final = 30.0 / math.pi
"""r/min in 1 rad/s."""
RAD_S: Final = math.pi / 30.0
"""rad/s in 1 r/min."""

UNITS: Final[dict[str, dict[str, float]]] = {
    "1": {},
    "s": {"s": 1},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "m/s2": {"m": 1, "s": -2},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "rad/s2": {"rad": 1, "s": -2},
    "kg": {"kg": 1},
    "kg.m": {"kg": 1, "m": 1},
    "kg.m2": {"kg": 1, "m": 2},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N.m/rad": {"kg": 1, "m": 2, "s": -2, "rad": -1},
    "N.m.s/rad": {"kg": 1, "m": 2, "s": -1, "rad": -1},
    "N.m.s": {"kg": 1, "m": 2, "s": -1},
    "N.m/s": {"kg": 1, "m": 2, "s": -3},
    "W": {"kg": 1, "m": 2, "s": -3},
    "Hz": {"s": -1},
    "kg^1/2.m": {"kg": 0.5, "m": 1},
    "kg^1/2.m/s": {"kg": 0.5, "m": 1, "s": -1},
    "kg^1/2.m/s2": {"kg": 0.5, "m": 1, "s": -2},
}

RATES: Final = {
    "m": "m/s",
    "m/s": "m/s2",
    "rad": "rad/s",
    "rad/s": "rad/s2",
    "N.m": "N.m/s",
    "N.m.s": "N.m",
    "kg^1/2.m": "kg^1/2.m/s",
    "kg^1/2.m/s": "kg^1/2.m/s2",
}
"""Units of the time derivatives of quantities that are states."""


def quantity(value: float, unit: str) -> str:
    """A value with its unit, for messages; the unit 1 is left out."""
    return f"{value:g}" if unit == "1" else f"{value:g} {unit}"


def si_name(powers: Iterable[tuple[str, float]]) -> str:
    """The first of `UNITS` with these exponents, "" if there is none."""
    wanted = dict(powers)
    return next((name for name, found in UNITS.items() if found == wanted), "")


def base_exponents(unit: str) -> dict[str, float]:
    """SI base-unit exponents of a unit.

    Raises:
        StructureError: the unit is not one of `UNITS`.
    """
    try:
        return UNITS[unit]
    except KeyError:
        known = ", ".join(UNITS)
        raise StructureError(f"unit '{unit}' is unknown; use one of: {known}") from None


def unit_dimension(unit: str) -> tuple:
    """Factor, offset and exponents of an SI unit, in the form that masters compare."""
    return (1.0, 0.0, tuple(sorted(base_exponents(unit).items())))
