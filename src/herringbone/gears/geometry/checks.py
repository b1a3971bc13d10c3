"""What makes a gear pair impossible, each said in one line before anything is computed."""

import math
from dataclasses import fields
from numbers import Integral, Real
from typing import TYPE_CHECKING

from herringbone.core import ParameterError
from herringbone.core.materials import DENSITY, MODULUS, meant, out_of_range
from herringbone.gears.geometry.given import full_root_fillet

if TYPE_CHECKING:
    from herringbone.gears.geometry.gear_pair import GearPair

GEARS = ("pinion", "wheel")
_POSITIVE = ("normal_module", "face_width")
_OPTIONAL = {
    "center_distance", "profile_shift_coefficient", "root_fillet_radius_coefficient",
    "tip_radius", "groove_diameter",
}  # fmt: skip
_ROUNDING = 0.01
"""Backlash that published dimensions may lack by rounding, in modules."""


def check_given(pair: "GearPair") -> None:
    """Check each value as it is given.

    Raises:
        ParameterError: the first that is not possible.
    """
    _check_numbers(pair)
    for gear, z in zip(GEARS, pair.number_of_teeth, strict=True):
        if not isinstance(z, Integral) or z < 3:
            raise ParameterError(f"{gear}: number of teeth {z} must be an integer of at least 3")
    _check_angles(pair)
    if pair.halves not in {1, 2}:
        raise ParameterError(f"halves = {pair.halves} must be 1 (single) or 2 (double helical)")
    _check_material(pair)
    if not -1.0 < pair.poissons_ratio < 0.5:
        raise ParameterError(f"Poisson's ratio {pair.poissons_ratio:g} must lie below 0.5")
    if pair.normal_module > 0.2:
        raise ParameterError(
            f"normal module {pair.normal_module:g} m is larger than 0.2 m; lengths are given in m"
        )
    if pair.gap_width < 0.0:
        raise ParameterError(f"gap width {pair.gap_width:g} m must not be negative")
    for gear, allowance in zip(GEARS, pair.tooth_thickness_allowance, strict=True):
        if allowance > 0.0:
            raise ParameterError(
                f"{gear}: tooth thickness allowance {1e6 * allowance:g} um must not be positive"
            )


def _check_numbers(pair: "GearPair") -> None:
    for field in fields(pair):
        value = getattr(pair, field.name)
        for item in value if isinstance(value, tuple) else (value,):
            given = item is not None or field.name not in _OPTIONAL
            if given and not (isinstance(item, Real) and math.isfinite(item)):
                raise ParameterError(f"{field.name} = {item!r} must be a finite number")
    for name in _POSITIVE:
        if not 0.0 < getattr(pair, name) < math.inf:
            raise ParameterError(f"{name} = {getattr(pair, name):g} must be positive (SI units)")


def _check_material(pair: "GearPair") -> None:
    for name, known in (("youngs_modulus", MODULUS), ("density", DENSITY)):
        value = getattr(pair, name)
        if problem := out_of_range(name, value, known):
            other = meant(value, known)
            hint = f"; write '{value:g} {other[0]}' if that is meant" if other else ""
            raise ParameterError(problem + hint)


def _check_angles(pair: "GearPair") -> None:
    if not math.radians(5.0) < pair.normal_pressure_angle < math.radians(45.0):
        raise ParameterError(
            f"normal pressure angle {math.degrees(pair.normal_pressure_angle):g} deg must lie "
            "between 5 and 45 deg; angles are given in rad"
        )
    if not abs(pair.helix_angle) < math.radians(60.0):
        raise ParameterError(
            f"helix angle {math.degrees(pair.helix_angle):g} deg must be below 60 deg; "
            "angles are given in rad"
        )


def check_meshing(pair: "GearPair") -> None:
    """Check that the teeth can be cut and mesh.

    Raises:
        ParameterError: see `GearPair`.
    """
    for gear, name in enumerate(GEARS):
        _check_tooth(pair, gear, name)
    if pair.normal_backlash < -_ROUNDING * pair.normal_module:
        raise ParameterError(
            f"normal backlash is negative: {1e6 * pair.normal_backlash:.1f} um; increase the "
            "center distance, or decrease profile shift or tooth thickness"
        )
    if pair.total_contact_ratio < 1.0:
        raise ParameterError(
            f"contact ratio {pair.total_contact_ratio:.3f} is below 1: teeth lose contact between "
            "meshes; use a larger addendum, a smaller center distance or a wider face"
        )
    _check_interference(pair)
    for gear, name in enumerate(GEARS):
        _check_body(pair, gear, name)


def _check_body(pair: "GearPair", gear: int, name: str) -> None:
    for what, diameter in (
        ("bore", pair.bore_diameter[gear]),
        ("groove", pair.groove_diameter[gear]),
    ):
        if not 0.0 <= diameter <= 2.0 * pair.root_radius[gear]:
            raise ParameterError(
                f"{name}: {what} diameter {1e3 * diameter:g} mm must lie between 0 and the root "
                f"diameter {2e3 * pair.root_radius[gear]:.4f} mm"
            )
    if pair.bore_diameter[gear] >= pair.groove_diameter[gear]:
        raise ParameterError(
            f"{name}: bore diameter {1e3 * pair.bore_diameter[gear]:g} mm must be smaller than "
            f"the groove diameter {1e3 * pair.groove_diameter[gear]:g} mm"
        )
    for what, value in (
        ("shaft diameter", pair.shaft_diameter[gear]),
        ("stub length", pair.stub_length[gear]),
    ):
        if value < 0.0:
            raise ParameterError(f"{name}: {what} {1e3 * value:g} mm must not be negative")


def _check_tooth(pair: "GearPair", gear: int, name: str) -> None:
    full = full_root_fillet(pair, gear)
    fillet = pair.root_fillet_radius_coefficient[gear]
    if not 0.0 <= fillet <= full + 1e-9:
        raise ParameterError(
            f"{name}: root fillet radius coefficient {fillet:g} must lie between 0 and {full:.4f}, "
            "where the rack's tip is fully round"
        )
    if pair.tip_radius[gear] <= pair.base_radius[gear]:
        raise ParameterError(
            f"{name}: tip radius {1e3 * pair.tip_radius[gear]:.4f} mm must be larger than the base "
            f"radius {1e3 * pair.base_radius[gear]:.4f} mm"
        )
    if pair.tip_tooth_thickness[gear] <= 0.0:
        raise ParameterError(
            f"{name}: teeth are pointed: tooth thickness at the tip radius "
            f"{1e3 * pair.tip_radius[gear]:.4f} mm is {1e3 * pair.tip_tooth_thickness[gear]:.4f} "
            "mm; decrease profile shift or addendum"
        )


def _check_interference(pair: "GearPair") -> None:
    for gear, name in enumerate(GEARS):
        if pair.tip_clearance[gear] <= 0.0:
            raise ParameterError(
                f"{name}: the mate's tips reach its root (clearance "
                f"{1e3 * pair.tip_clearance[gear]:.4f} mm); center distance "
                f"{1e3 * pair.center_distance:.4f} mm is too small, or an addendum too large"
            )
    path = pair.path_of_contact
    for gear, reach in enumerate((path.start, path.tangent_length - path.end)):
        _check_lowest_contact(pair, gear, reach)


def _check_lowest_contact(pair: "GearPair", gear: int, reach: float) -> None:
    """The flank must reach down to where contact begins, `reach` behind the base tangent point."""
    profile = pair.tooth_profile(gear)
    lowest = math.hypot(pair.base_radius[gear], reach)
    slack = 0.0 if profile.undercut else _ROUNDING * pair.normal_module
    if reach >= 0.0 and lowest >= profile.form_radius - slack:
        return
    where = (
        f"contact would begin at radius {1e3 * lowest:.4f} mm, the involute begins at "
        f"{1e3 * profile.form_radius:.4f} mm"
    )
    if profile.undercut:
        raise ParameterError(
            f"{GEARS[gear]}: teeth are undercut where they touch: {where}; use more teeth, a "
            "larger profile shift or a smaller dedendum"
        )
    raise ParameterError(
        f"{GEARS[gear]}: the mate's tips touch below its involute: {where}; decrease the mate's "
        "tip radius"
    )
