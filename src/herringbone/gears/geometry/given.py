"""Completes what a gear pair is given: centre distance, profile shifts, fillets, tips."""

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from herringbone.core import ParameterError
from herringbone.gears.geometry.involute import STEEPEST, involute, involute_angle

if TYPE_CHECKING:
    from herringbone.gears.geometry.gear_pair import GearPair

Pair = tuple[float, float]
_DEFAULT_ROOT_FILLET = 0.38


def as_pair(values: Iterable[float]) -> Pair:
    """Values of both gears: (pinion, wheel)."""
    pinion, wheel = values
    return pinion, wheel


def center_distance(pair: "GearPair") -> float:
    """The centre distance given, or that of the profile shifts without backlash [m]."""
    if pair.center_distance is not None:
        least = pair.reference_center_distance * math.cos(pair.transverse_pressure_angle)
        if pair.center_distance <= least:
            raise ParameterError(
                f"center distance {1e3 * pair.center_distance:.4f} mm is impossible: the base "
                f"circles need more than {1e3 * least:.4f} mm; check teeth, module and helix "
                "angle"
            )
        return pair.center_distance
    if None in pair.profile_shift_coefficient:
        raise ParameterError("center distance and profile shift are both missing; give one of them")
    total = sum(pair.profile_shift_coefficient)
    tan_n = math.tan(pair.normal_pressure_angle)
    value = (
        involute(pair.transverse_pressure_angle)
        + 2.0 * tan_n * total / sum(pair.number_of_teeth)
    )  # fmt: skip
    if not 0.0 < value < involute(STEEPEST):
        raise ParameterError(
            f"profile shifts x1 + x2 = {total:g} leave no working pressure angle; use a "
            f"{'smaller' if total > 0.0 else 'larger'} sum"
        )
    cosines = math.cos(pair.transverse_pressure_angle) / math.cos(involute_angle(value))
    return pair.reference_center_distance * cosines


def profile_shifts(pair: "GearPair") -> Pair:
    """The profile shift coefficients given; what is None follows from the centre distance."""
    x1, x2 = pair.profile_shift_coefficient
    turned = involute(pair.working_transverse_pressure_angle) - involute(
        pair.transverse_pressure_angle
    )
    total = 0.5 * sum(pair.number_of_teeth) * turned / math.tan(pair.normal_pressure_angle)
    if x1 is None and x2 is None:
        return 0.5 * total, 0.5 * total
    if x1 is None:
        return total - x2, x2
    return (x1, total - x1) if x2 is None else (x1, x2)


def root_fillets(pair: "GearPair") -> Pair:
    """Root fillet radius coefficients given, or 0.38, or what the rack has room for."""
    given = pair.root_fillet_radius_coefficient
    return as_pair(
        min(_DEFAULT_ROOT_FILLET, full_root_fillet(pair, gear)) if given[gear] is None
        else given[gear]
        for gear in range(2)
    )  # fmt: skip


def full_root_fillet(pair: "GearPair", gear: int) -> float:
    """Largest root fillet radius of the basic rack, in modules."""
    alpha = pair.normal_pressure_angle
    room = 0.25 * math.pi - pair.dedendum_coefficient[gear] * math.tan(alpha)
    return room * math.cos(alpha) / (1.0 - math.sin(alpha))


def tip_radii(pair: "GearPair") -> Pair:
    """Tip radii given, or from the addendum [m]."""
    given = pair.tip_radius
    return as_pair(
        pair.reference_radius[gear]
        + pair.normal_module
        * (
            pair.addendum_coefficient[gear]
            + pair.profile_shift_coefficient[gear]
            + pair.tip_alteration_coefficient[gear]
        )
        if given[gear] is None
        else given[gear]
        for gear in range(2)
    )
