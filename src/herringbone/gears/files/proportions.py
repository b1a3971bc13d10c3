"""Lengths out of proportion: without their unit a thousand or a million times too long; shafts."""

from collections.abc import Mapping, Sequence

from herringbone.core import ParameterError
from herringbone.gears.geometry.checks import GEARS
from herringbone.gears.geometry.gear_pair import GearPair

_AXIAL = ("face_width", "gap_width", "shaft_diameter", "stub_length")
_DIAMETERS = 30.0
"""Lengths along the shafts at most, in reference diameters."""
_FLANK = {"tip_relief": 1.0, "helix_crowning": 1.0, "backlash": 1.0, "relief_length": 30.0}
"""Lengths at the flanks at most, in modules."""


def check_proportions(
    pair: GearPair, at_flanks: Mapping[str, float | Sequence[float] | None]
) -> None:
    """Check that lengths have the order of magnitude of the gears.

    Args:
        pair: the gears.
        at_flanks: lengths at the flanks by key [m]; other keys are left alone.

    Raises:
        ParameterError: the first that is out of proportion, with what may be meant; or a shaft
            that is thicker than the gear's root.
    """
    for name in _AXIAL:
        for gear, length in enumerate(_several(getattr(pair, name))):
            diameter = 2.0 * pair.reference_radius[gear]
            if length > _DIAMETERS * diameter:
                beside = f"the {GEARS[gear]}'s reference diameter of {1e3 * diameter:.6g} mm"
                raise _too_long(name, length, diameter, beside, "mm")
    _check_shafts(pair)
    for name, most in _FLANK.items():
        for length in _several(at_flanks.get(name)):
            if length > most * pair.normal_module:
                beside = f"the normal module of {1e3 * pair.normal_module:g} mm"
                unit = "mm" if name == "relief_length" else "um"
                raise _too_long(name, length, pair.normal_module, beside, unit)


def _check_shafts(pair: GearPair) -> None:
    """A stub beside the face that is thicker than the root has no room for the tool."""
    for gear, shaft in enumerate(pair.shaft_diameter):
        root = 2.0 * pair.root_radius[gear]
        if shaft > root and pair.stub_length[gear] > 0.0:
            raise ParameterError(
                f"{GEARS[gear]}: shaft_diameter {1e3 * shaft:g} mm must not be larger than the "
                f"root diameter {1e3 * root:.4f} mm"
            )


def _several(given: float | Sequence[float] | None) -> Sequence[float]:
    if given is None:
        return ()
    return (given,) if isinstance(given, int | float) else given


def _too_long(what: str, length: float, unit: float, beside: str, meant: str) -> ParameterError:
    return ParameterError(
        f"{what} = {length:g} m is {length / unit:.3g} times {beside}; lengths without a unit are "
        f"in m: write '{length:g} {meant}' if that is meant"
    )
