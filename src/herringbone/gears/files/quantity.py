"""Numbers with units, as gear files have them, into SI."""

from collections.abc import Mapping
from fractions import Fraction
from numbers import Real

from herringbone.core import ResourceError
from herringbone.core.reading.numbers import number

UNITS: Mapping[str, Mapping[str, str]] = {
    "length": {"m": "1", "mm": "1e-3", "um": "1e-6", "mum": "1e-6"},
    "angle": {"rad": "1", "deg": "0.017453292519943295", "°": "0.017453292519943295"},
    "stress": {"Pa": "1", "MPa": "1e6", "GPa": "1e9", "N/mm2": "1e6", "N/mm^2": "1e6"},
    "density": {"kg/m3": "1", "kg/m^3": "1", "kg/dm^3": "1e3", "g/cm3": "1e3", "t/mm3": "1e12"},
    "torque": {"N m": "1", "Nm": "1", "kN m": "1e3", "kNm": "1e3"},
    "force": {"N": "1", "kN": "1e3"},
    "number": {"": "1", "1": "1", "none": "1", "-": "1"},
}
"""Units by quantity, and what one is in SI; as text, so that 47.3 mm is the number 0.0473."""


def in_si(value: float, unit: str, kind: str, where: str) -> float:
    """A value in SI.

    Raises:
        ResourceError: the unit is none of this quantity.
    """
    written = unit.strip()
    units = UNITS[kind]
    factor = units.get(written, units.get(written.replace(" ", "")))
    if factor is None:
        known = ", ".join(name for name in units if name) or "no unit"
        raise ResourceError(f"{where}: unit '{written or 'none'}' is no {kind}; it takes {known}")
    try:
        return float(Fraction(repr(value)) * Fraction(factor))
    except OverflowError:
        raise ResourceError(f"{where}: {value:g} {written} is too large") from None


def quantity(value: object, kind: str, where: str) -> float:
    """A number in SI, or text such as "3.5 mm".

    Raises:
        ResourceError: neither, or another unit.
    """
    if isinstance(value, Real) and not isinstance(value, bool):
        return float(value)
    digits, _, unit = str(value).strip().partition(" ")
    try:
        parsed = number(digits)
    except ValueError:
        raise ResourceError(
            f"{where} = {value!r} is no {kind}; give a number in SI or text such as "
            f"'{_EXAMPLES[kind]}'"
        ) from None
    return in_si(parsed, unit, kind, where)


_EXAMPLES = {
    "length": "3.5 mm", "angle": "30 deg", "stress": "206 GPa", "density": "7850 kg/m3",
    "torque": "200 N m", "force": "2.25 kN", "number": "0.5",
}  # fmt: skip
