"""Ranges of what gears and housings are made of; outside of them a value has another unit."""

from collections.abc import Mapping
from typing import NamedTuple


class Range(NamedTuple):
    """Least and most value, their unit, and what other units that may be meant are in it."""

    least: float
    most: float
    unit: str
    others: Mapping[str, float]


MODULUS = Range(1e8, 1e12, "Pa", {"GPa": 1e9, "MPa": 1e6})
DENSITY = Range(500.0, 25e3, "kg/m3", {"g/cm3": 1e3, "t/mm3": 1e12})


def out_of_range(name: str, value: float, known: Range) -> str | None:
    """What is wrong with a value, if anything, such as 'density = 7.85 kg/m3 must lie ...'."""
    least, most, unit, _ = known
    if least <= value <= most:
        return None
    return f"{name} = {value:g} {unit} must lie between {least:g} and {most:g} {unit}"


def meant(value: float, known: Range) -> tuple[str, float] | None:
    """The unit that a value out of range may have, and the value in SI; None if there is none."""
    for unit, si in known.others.items():
        if known.least <= value * si <= known.most:
            return unit, value * si
    return None
