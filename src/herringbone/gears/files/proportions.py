"""Lengths out of proportion, as with no unit or another than is meant; shafts."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from herringbone.core import ParameterError
from herringbone.gears.files.quantity import quantity
from herringbone.gears.geometry.checks import GEARS
from herringbone.gears.geometry.gear_pair import GearPair

_UNITS = ("mm", "um", "m")
"""Units that may be meant, the likeliest first."""
_AXIAL = ("face_width", "gap_width", "shaft_diameter", "stub_length")
_DIAMETERS = 30.0
"""Lengths along the shafts at most, in reference diameters."""
_FLANK = {"tip_relief": 1.0, "helix_crowning": 1.0, "backlash": 1.0, "relief_length": 30.0}
"""Lengths at the flanks at most, in modules."""
_NARROWEST = 0.1
"""Face width at least, in modules."""
_OFTEN = 0.25
"""Lengths at the flanks that may be meant, as a share of the largest."""


def check_proportions(
    pair: GearPair,
    at_flanks: Mapping[str, float | Sequence[float] | None],
    written: Mapping[str, object] = MappingProxyType({}),
) -> None:
    """Check that lengths have the order of magnitude of the gears.

    Args:
        pair: the gears.
        at_flanks: lengths at the flanks by key [m]; other keys are left alone.
        written: by key, what the file has: numbers in m, texts with a unit, or lists of them.

    Raises:
        ParameterError: the first that is out of proportion, with what may be meant; or a shaft
            that is thicker than the gear's root.
    """
    module = pair.normal_module
    beside = f"the normal module of {1e3 * module:g} mm"
    if pair.face_width < _NARROWEST * module:
        within = (module, _DIAMETERS * 2.0 * pair.reference_radius[0])
        face = _Length("face_width", pair.face_width, written.get("face_width"))
        raise _out_of_proportion(face, module, beside, within)
    for name in _AXIAL:
        for gear, length in enumerate(_lengths(name, getattr(pair, name), written)):
            diameter = 2.0 * pair.reference_radius[gear]
            if length.value > (most := _DIAMETERS * diameter):
                of_gear = f"the {GEARS[gear]}'s reference diameter of {1e3 * diameter:.6g} mm"
                raise _out_of_proportion(length, diameter, of_gear, (0.0, most))
    _check_shafts(pair)
    for name, modules in _FLANK.items():
        for length in _lengths(name, at_flanks.get(name), written):
            if length.value > (most := modules * module):
                raise _out_of_proportion(length, module, beside, (0.0, _OFTEN * most))


def _check_shafts(pair: GearPair) -> None:
    """A stub beside the face that is thicker than the root has no room for the tool."""
    for gear, shaft in enumerate(pair.shaft_diameter):
        root = 2.0 * pair.root_radius[gear]
        if shaft > root and pair.stub_length[gear] > 0.0:
            raise ParameterError(
                f"{GEARS[gear]}: shaft_diameter {1e3 * shaft:g} mm must not be larger than the "
                f"root diameter {1e3 * root:.4f} mm"
            )


class _Length(NamedTuple):
    """A length by its key: in m, and as the file has it, None if that is not known."""

    name: str
    value: float
    written: object


def _lengths(
    name: str, given: float | Sequence[float] | None, written: Mapping[str, object]
) -> list[_Length]:
    if given is None:
        return []
    values = [given] if isinstance(given, int | float) else given
    texts = written.get(name)
    texts = texts if isinstance(texts, list) else [texts] * len(values)
    return [_Length(name, *both) for both in zip(values, texts, strict=False)]


def _out_of_proportion(
    length: _Length, unit: float, beside: str, within: tuple[float, float]
) -> ParameterError:
    """The error, with the unit that gives a length `within` [m], if one does."""
    bare = isinstance(length.written, int | float)
    text = str(length.written) if isinstance(length.written, str) else f"{length.value:g} m"
    digits = text.strip().partition(" ")[0]
    fits = (f"{digits} {other}" for other in _UNITS if _is_within(f"{digits} {other}", within))
    other = next(fits, None) if length.written is not None else None
    return ParameterError(
        f"{length.name} = {text} is {length.value / unit:.3g} times {beside}; "
        + ("lengths without a unit are in m: " * bare)
        + (f"write '{other}' if that is meant" if other else "check its unit")
    )


def _is_within(text: str, within: tuple[float, float]) -> bool:
    return within[0] <= quantity(text, "length", text) <= within[1]
